/* Pair constants of a contact: E*, G*, damping and friction from the species of both sides, reduced radius R*
   and reduced mass m*. With a single species every look-up is one constant. */

/* The grains of a work-item after `step` steps of the interval. `materials`: those of all replicas; replica
   `r` has the SPECIES materials that start at r * SPECIES. */
INLINE Grain grain_at(global const Replica* replica, global const Material* materials, int r, int first,
                      int step, Moving now) {
    const Grain at = {replica,
                      SPECIES > 1 ? materials + r * SPECIES : &replica->material,
                      first,
                      FIRST_SLOT(first),
                      SLOTS_HERE,
                      plate_position(replica, step),
                      replica->time_step * step,
                      now};
    return at;
}

/* Offset of a member in Material, in reals. */
#define PLACE_OF(member) ((int)((size_t) & ((global const Material*)0)->member / sizeof(real)))
#define MATERIAL_REALS ((int)(sizeof(Material) / sizeof(real)))

/* A constant of the grains' own materials; a scalar if SPECIES is 1 or LANES is 1. */
#if SPECIES > 1 && LANES > 1
#define OWN(at, member) \
    gather((global const real*)(at).materials + PLACE_OF(member), AS_SLOTS((at).now.species) * MATERIAL_REALS)
typedef lanes own_constant;
#else
#if SPECIES > 1
#define SPECIES_OF(at) ((int)(at).now.species)
#else
#define SPECIES_OF(at) 0
#endif
#define OWN_MATERIAL(at) ((at).materials + SPECIES_OF(at))
#define OWN(at, member) (OWN_MATERIAL(at)->member)
typedef real own_constant;
#endif

/* A pair constant of each lane's grain and neighbour. */
#if SPECIES > 1
#define OF_PAIRS(at, member, neighbour)                           \
    gather((global const real*)(at).materials + PLACE_OF(member), \
           AS_SLOTS((at).now.species) * MATERIAL_REALS + (neighbour).species)
#else
#define OF_PAIRS(at, member, neighbour) \
    WHERE((neighbour).wall, (at).materials->member[WALL_COLUMN], (at).materials->member[0])
#endif

/* A constant of the neighbours' own materials, given by its PLACE_OF; arbitrary for walls. */
INLINE lanes of_neighbours(Grain at, Neighbours neighbour, int place) {
    global const real* of_first = (global const real*)at.materials + place;
#if SPECIES > 1
    return gather(of_first, (neighbour.species & (MAX_SPECIES - 1)) * MATERIAL_REALS);
#else
    return *of_first;
#endif
}

INLINE lanes sphere_mass(Grain at, lanes radius) {
    return OWN(at, density) * (R(4) / R(3)) * PI * radius * radius * radius;
}

/* R* and m* of each pair, with one division; both sides of a pair get the same bits. */
typedef struct {
    lanes radius, mass;
} Reduced;

/* Factor of m* for unequal densities: rho_i rho_j (c_i + c_j) / (rho_i c_i + rho_j c_j), with densities rho
   relative to the first species and cubes c of the radii. Exactly 1 for two grains of the first species. */
INLINE lanes relative_mass(Grain at, Neighbours neighbour, lanes cubes, lanes cube, lanes cube_there) {
    const lanes here = OWN(at, relative_density);
    const lanes there = of_neighbours(at, neighbour, PLACE_OF(relative_density));
    const lanes both = here * there * cubes / add_alike(here * cube, there * cube_there);
    return WHERE(neighbour.wall, here, both);
}

INLINE Reduced reduced(Grain at, Neighbours neighbour) {
    const lanes radius = at.now.radius, cube = radius * radius * radius;
    const lanes sum = radius + neighbour.radius, product = radius * neighbour.radius;
    const lanes cube_there = neighbour.radius * neighbour.radius * neighbour.radius;
    const lanes cubes = add_alike(cube, cube_there);
    const lanes part = product / (sum * cubes);
    const real density = at.materials->density * (R(4) / R(3)) * PI;
    Reduced r;
    r.radius = WHERE(neighbour.wall, radius, part * cubes);
    r.mass =
        WHERE(neighbour.wall, density * radius * radius * radius, density * (part * sum) * product * product);
#if SPECIES > 1
    r.mass *= relative_mass(at, neighbour, cubes, cube, cube_there);
#endif
    return r;
}
