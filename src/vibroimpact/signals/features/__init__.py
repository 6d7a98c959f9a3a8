"""The features, a file each family; a file put here is found by itself."""
