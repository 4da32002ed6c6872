mod parts;
mod rig;
mod track;
