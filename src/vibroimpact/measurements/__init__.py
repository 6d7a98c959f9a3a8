"""Reading of measurement files: CSV tables and universal files."""
