"""What follows from results: numbers in words, tables, files, plain data."""
