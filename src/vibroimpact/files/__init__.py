"""Files and folders: read whole or refused with a sentence, written whole or not at all, with check sums on what is read back."""
