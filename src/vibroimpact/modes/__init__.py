"""The modes of the elastic bodies of a case: tables, pictures and meshes."""
