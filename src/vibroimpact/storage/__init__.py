"""The result folder: what it holds, and how it is written whole or not at all."""
