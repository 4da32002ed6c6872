mod directions;
mod guide;
mod identity;
