"""The sphere, the plate, the motion and the contact of a case as a problem of rigid bodies."""
