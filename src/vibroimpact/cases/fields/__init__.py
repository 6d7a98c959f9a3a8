"""Fields of the case file: quantities, materials, supports, damping and meshes, their
validation and their error messages.
"""
