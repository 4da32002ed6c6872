mod directions;
mod guide;
