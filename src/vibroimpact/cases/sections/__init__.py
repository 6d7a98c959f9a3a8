"""The sections of the case file with their keys, and what is written from them."""
