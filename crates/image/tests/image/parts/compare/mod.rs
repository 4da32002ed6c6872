mod flip;
mod hdr_flip;
