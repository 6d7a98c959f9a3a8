"""The modes of measured frequency responses, alone or beside those of a case."""
