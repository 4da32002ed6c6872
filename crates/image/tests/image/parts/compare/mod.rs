mod flip;
