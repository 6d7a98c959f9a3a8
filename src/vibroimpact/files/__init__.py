"""Files and folders: checked reading, atomic writing, recovery after a crash, and checksums."""
