mod levels;
mod lookup;
