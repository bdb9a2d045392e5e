"""Units, texts, files and progress: nothing about contact."""
