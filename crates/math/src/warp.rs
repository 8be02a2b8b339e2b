//! Maps from the unit square to disks, spheres and cones, each with its density and its inverse.
