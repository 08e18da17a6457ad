"""What effects and observables of a diagnosis are called and mean: host/diagnose/effects.cpp, observe/scan_observables.cpp."""
from typing import NamedTuple


class Effect(NamedTuple):
    words: str  # in texts; empty: the name with blanks
    amplitude: str  # its meaning
    source: str  # reference for the formula


EFFECTS = {
    "cross_contact": Effect(
        "cross-contact deformation",
        "gamma of the paper's Eq. 1: the force at a contact displaces the surface at all other contacts",
        "Brodu, Dijksman & Behringer 2015"),
    "bulge_contacts": Effect(
        "contacts made by surface displacement",
        "fraction of the surface displacement that creates no contact between spheres that do not overlap undeformed",
        "Brodu, Dijksman & Behringer 2015"),
    "friction": Effect("friction between grains", "change of mu between grains", "Coulomb"),
    "wall_friction": Effect("friction at the walls", "change of mu at walls", "Coulomb"),
    "friction_history": Effect(
        "friction with memory",
        "share of the other law of friction (saturated or Mindlin's)",
        "Mindlin & Deresiewicz 1953"),
    "adhesion": Effect("", "work of adhesion w: touching grains attract by 2 pi w R*", "Derjaguin, Muller & Toporov 1975"),
    "adhesion_net_friction": Effect(
        "adhesion with friction of the net force",
        "adhesion where Coulomb's law holds for the net force",
        "Derjaguin, Muller & Toporov 1975"),
    "cohesion": Effect("cohesion per contact area", "k: attraction over the area 2 pi R* overlap of a contact", '"SJKR" of LIGGGHTS'),
    "viscoelasticity": Effect("", "fraction of the Hertz force that relaxes while a contact is held", "standard linear solid"),
    "stiffening": Effect("stiffening at large strain", "c in F = F_Hertz (1 + c overlap/R*)", "first correction to Hertz at large strain"),
    "finite_strain": Effect(
        "finite strain of the grains",
        "fraction of the finite-strain correction of an elastic sphere",
        "finite elements of a neo-Hookean sphere"),
    "plasticity": Effect("", "fraction of the largest overlap that remains after unloading", "Walton & Braun 1986"),
    "buoyancy": Effect("weight under buoyancy", "change of the grains' density over the fluid's", "Archimedes"),
    "diameter_error": Effect("error of all diameters", "true minus stated diameter, equal for all grains", "measurement"),
    "polydispersity": Effect("scatter of diameters", "standard deviation of true minus stated diameter", "measurement"),
    "modulus_scatter": Effect("scatter of moduli", "standard deviation of ln E from grain to grain", "log-normal scatter"),
    "rolling_resistance": Effect(
        "",
        "mu_r: a spring resists rolling and yields at the torque mu_r R* F_n",
        "Iwashita & Oda 1998; Ai et al. 2011, model C"),
    "plate_tilt": Effect("tilt of the plate along x", "slope of the plate along x", "geometry"),
    "plate_tilt_y": Effect("tilt of the plate along y", "slope of the plate along y", "geometry"),
    "plate_compliance": Effect("compliance of the plate", "deflection of the plate per newton", "linear spring"),
    "force_bias": Effect("bias of contact forces", "relative error by which contact forces are measured too large", "measurement"),
    "gauge_drift": Effect(
        "drift of the load cell's gain",
        "relative error of the load cell's gain at the end of the last cycle; it grows in proportion to the plate's path",
        "measurement"),
    "zero_drift": Effect(
        "drift of the load cell's zero",
        "offset of the load cell at the end of the last cycle, over the maximum top force; it grows in proportion to "
        "the plate's path",
        "measurement"),
    "gauge_hysteresis": Effect(
        "hysteresis of the load cell",
        "excess of the top force during unloading, at half the maximum force, over the maximum force",
        "measurement"),
    "force_lag": Effect("lag of the load cell", "plate travel by which the reading of the top force lags", "measurement"),
    "guide_friction": Effect(
        "friction of the plate's guide",
        "friction of the plate's guide, which the load cell also reads, over the maximum force",
        "measurement"),
    "force_saturation": Effect("saturation of contact forces", "a in f/(1 + a f), what is read of a contact force f", "measurement"),
    "force_threshold": Effect("shifted force threshold", "true minus stated threshold of contact forces", "measurement"),
    "position_bias": Effect("bias of positions", "relative error by which lengths are measured too large", "measurement"),
    "plate_speed": Effect("speed of the plate", "fraction by which the real plate is slower than the scene's", "numerics"),
    "inertia": Effect(
        "inertia of the grains",
        "fraction by which real inertia is smaller than the scene's, with the same weight",
        "numerics"),
    "time_step": Effect("", "fraction by which the time step is too long", "numerics"),
}

OBSERVABLES = {
    "top_force": "log of the force on the plate",
    "floor_force": "force on the floor over that on the plate",
    "side_force": "a quarter of the normal forces on the sides over the force on the plate",
    "plate_contacts": "sum of the contact forces at the plate over the plate's own reading",
    "plate_couple_x": "centre of the plate's load along x, over half the box",
    "plate_couple_y": "centre of the plate's load along y, over half the box",
    "coordination_number": "contacts per grain",
    "weak_contacts": "contacts per grain with one to two times the force threshold",
    "mean_force": "log of the mean contact force",
    "force_spread": "standard deviation of contact forces over their mean",
    "weak_forces": "fraction of the contacts below 0.3 mean forces",
    "strong_forces": "fraction of the contacts above 2 mean forces",
    "strongest_forces": "95 % quantile of contact forces over their mean",
    "section_load": "vertical force through horizontal sections, what the side walls carry above them added, over the plate's reading",
    "force_anisotropy": "vertical share of normal forces, minus one third",
    "vertical_gradient": "change of the mean contact force with depth, over the height",
    "non_affine": "non-affine displacement since the first scan, over the mean diameter",
    "attraction": "fraction of the contacts that pull",
    "friction_ratio": "mean ratio of tangential to normal force between grains",
    "friction_high": "80 % quantile of this ratio between grains",
    "friction_sliding": "fraction of the contacts between grains where this ratio is within 20 % of the stated friction",
    "wall_friction_ratio": "mean ratio of tangential to normal force at walls",
    "wall_friction_high": "80 % quantile of this ratio at walls",
    "torque_imbalance": "sum over grains of the net torque of the contacts, over the sum of the contacts' torques",
    "gap_contacts": "contacts per grain between spheres that do not overlap",
    "silent_overlaps": "overlapping pairs without a listed contact, per grain",
    "overlap_offset": "implied minus measured overlap of grains, at zero force",
    "overlap_slope": "change of implied minus measured overlap of grains with the implied overlap",
    "overlap_curvature": "change of implied minus measured overlap of grains with the square of the implied overlap",
    "cross_contact": "change of implied minus measured overlap of grains with the surface displacement by the other contacts",
    "overlap_scatter": "standard deviation over contacts of the residuals of this regression",
    "grain_scatter": "standard deviation over grains of their mean residual",
    "grain_scatter_slope": "standard deviation over grains of the slope of their residuals with the overlap",
    "side_overlap_offset": "implied minus measured overlap at the side walls, at zero force",
    "side_overlap_slope": "change of implied minus measured overlap at the side walls with the implied overlap",
    "floor_overlap_offset": "implied minus measured overlap at the floor, mean",
    "plate_overlap_offset": "implied minus measured overlap at the plate, mean",
    "plate_overlap_tilt_x": "slope along x of implied minus measured overlap at the plate, in R over half the box",
    "plate_overlap_tilt_y": "slope along y of implied minus measured overlap at the plate, in R over half the box",
    "displacement": "displacement of the plate over the stroke, where the force on it is set",
    "relaxation": "log of the force on the plate at the beginning of a hold of its position, minus that at the end",
    "creep": "downward displacement of the plate during a hold of its force, over the stroke",
}
