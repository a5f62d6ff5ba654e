"""Writers, one file format per file."""
