mod choice;
mod names;
mod report;
