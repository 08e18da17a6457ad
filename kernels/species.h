/* What a contact's constants follow from where grains are of several species: the species of the other side.
   With one species every look-up is that of a plain constant. */

/* As it stands after `step` steps of the interval. `materials`: of all replicas, from number `r` on its own.
 */
INLINE Grain grain_at(global const Replica* replica, global const Material* materials, int r, int index,
                      int step, Motion now) {
#if SPECIES > 1
    global const Material* own = materials + r * SPECIES;
#else
    global const Material* own = &replica->material;
#endif
    const Grain at = {replica,
                      own,
                      own + SPECIES_OF(now),
                      index,
                      (size_t)index * SLOTS,
                      plate_position(replica, step),
                      replica->time_step * step,
                      now};
    return at;
}

/* The entries of a row of pairs for what each slot meets. */
INLINE lanes of_pairs(global const real* row, Neighbours seen) {
#if SPECIES > 1
    return gather(row, seen.species);
#else
    return WHERE(seen.wall, row[WALL_COLUMN], row[0]);
#endif
}

/* Of a constant in a material, in reals, of which it is made. */
#define PLACE_OF(member) ((int)((size_t) & ((global const Material*)0)->member / sizeof(real)))

/* One constant of the neighbours' own materials, by its place; any where there is a wall. */
INLINE lanes of_neighbours(Grain at, Neighbours seen, int place) {
    global const real* of_first = (global const real*)at.materials + place;
#if SPECIES > 1
    return gather(of_first, (seen.species & (MAX_SPECIES - 1)) * (int)(sizeof(Material) / sizeof(real)));
#else
    return *of_first;
#endif
}

INLINE real sphere_mass(Grain at, real radius) {
    return at.material->density * (R(4) / R(3)) * PI * radius * radius * radius;
}

/* R* and m* of each pair from one division; both sides of a pair get the same bits. */
typedef struct {
    lanes radius, mass;
} Reduced;

/* rho_i rho_j (c_i + c_j) / (rho_i c_i + rho_j c_j) over the first species' density, c the radii's cubes:
   what unlike densities change of m*. One where they are alike, to the bit. */
INLINE lanes relative_mass(Grain at, Neighbours seen, lanes cubes, real cube, lanes cube_there) {
    const real here = at.material->relative_density;
    const lanes there = of_neighbours(at, seen, PLACE_OF(relative_density));
    const lanes both = here * there * cubes / add_alike(here * cube, there * cube_there);
    return WHERE(seen.wall, here, both);
}

INLINE Reduced reduced(Grain at, Neighbours seen) {
    const real radius = at.now.position.w, cube = radius * radius * radius;
    const lanes sum = radius + seen.radius, product = radius * seen.radius;
    const lanes cube_there = seen.radius * seen.radius * seen.radius;
    const lanes cubes = add_alike(cube, cube_there);
    const lanes part = product / (sum * cubes);
    const real density = at.materials->density * (R(4) / R(3)) * PI;
    Reduced r;
    r.radius = WHERE(seen.wall, radius, part * cubes);
    r.mass = WHERE(seen.wall, density * radius * radius * radius, density * (part * sum) * product * product);
#if SPECIES > 1
    r.mass *= relative_mass(at, seen, cubes, cube, cube_there);
#endif
    return r;
}
