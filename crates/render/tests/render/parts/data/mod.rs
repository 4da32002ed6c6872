mod lights;
mod mattes;
mod picture;
