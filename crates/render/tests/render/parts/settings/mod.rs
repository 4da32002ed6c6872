mod acceleration;
mod choices;
mod crop;
