mod directions;
