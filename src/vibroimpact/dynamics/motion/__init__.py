"""What the motion of any drop consists of: flights, contacts, bounces, and tables of impacts."""
