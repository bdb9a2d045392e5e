"""The page of ``nacre app``, on this computer alone: verdicts, pictures, reports without code."""
