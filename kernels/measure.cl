/* Kernels `measure` and `reduce`: the state at the end of an interval of steps. `measure` computes the force,
   overlap and arm of every slot, and the energies and the highest frequency of every grain. `reduce` computes
   sums and maxima over each portion of a replica, in a fixed order. */

/* Sums (and a maximum) over a grain's contacts. */
typedef struct {
    lanes stored;    /* energy [J] */
    lanes deepest;   /* largest corrected overlap over overlap_scale() */
    lanes stiffness; /* sum of dF/d(approach), each contact on its own [N/m] */
    lanes displaced; /* sum of F b^2/delta [J] */
    lanes pressed;   /* sum of F delta, half of it for contacts with grains [J] */
} ContactSums;

/* Elastic energy of a contact that is attributed to this grain: Hertz's 2/5 F delta (half of it for contacts
   with grains), minus the work F b of its own surface displacement, plus the energy stored by that
   displacement and by effects. The displacement stores F b/2 in models of point forces. In sphere models it
   stores the integral of b over F: the contact's own part is added here, that of other contacts in
   surface_energy. */
INLINE lanes elastic_energy(Grain at, int effects, Neighbours neighbour, Contacts c) {
    global const Replica* restrict replica = at.replica;
    lanes displaced = R(0.5) * c.elastic * c.displacement;
    if (replica->finite_contacts)
        displaced = replica->confinement ? (lanes)(R(0)) : own_work(at, c.elastic, c.radius);
    lanes energy =
        c.elastic * (WHERE(neighbour.wall, R(0.4), R(0.2)) * c.overlap - c.displacement) + displaced;
    if (effects) energy += WHERE(neighbour.wall, R(1), R(0.5)) * c.energy;
    return energy;
}

/* Sphere models: energy stored by the surface displacements of a grain, the integral of b over the forces.
   With confinement it includes the contacts' own displacements [J]. */
INLINE lanes surface_energy(Grain at, EXCHANGE ContactTable* table) {
    SYNCHRONISE();
    SurfaceDisplacement b[SLOTS_HERE];
    sphere_sums(at, table, b);
    return confined_work(at, confined(at, b, table));
}

INLINE void add_contact_sums(Grain at, Neighbours neighbour, Displaced b, Contacts c,
                             ContactSums* restrict sums) {
    const int effects = at.replica->effects;
    const lanes share = WHERE(neighbour.wall, R(1), R(0.5)), force = c.elastic;
    const lanes overlap = WHERE(c.touching, c.overlap, R(1));
    /* Overlap without the contact's own displacement, which increases with its force. */
    const lanes without_own = b.here + b.there - (neighbour.distance - (at.now.radius + neighbour.radius));
    sums->stored += elastic_energy(at, effects, neighbour, c);
    sums->deepest =
        fmax(sums->deepest, WHERE(neighbour.occupied, c.overlap / overlap_scale(at, neighbour), R(0)));
    sums->stiffness += R(1.5) * force / fmax(R(1.5) * without_own - R(0.5) * overlap, R(0.25) * overlap);
    sums->displaced += force * b.here * b.here / overlap;
    sums->pressed += share * force * overlap;
}

/* Fields that measure() writes, one value per slot; `force`: the three rows of this work-item. */
typedef struct {
    global real *force, *overlap, *arm;
} MeasuredRows;

/* The field `force` has three rows for the grains of a work-item, one per axis. */
INLINE size_t force_row(int grain, int axis) {
    return ((size_t)(grain / LANES) * 3 + axis) * (LANES * SLOTS) + grain % LANES;
}

INLINE ContactSums measure_contacts(Grain at, Batch batch, MeasuredRows rows, EXCHANGE ContactTable* table) {
    global const Replica* restrict replica = at.replica;
    global real* kept = memory_of(at, batch.memory);
    ContactSums sums = {R(0), R(0), R(0), R(0), R(0)};
    for (int v = 0; v < at.count; ++v) {
        const slots partner = load_number(batch.partner, at.row, v);
        const Neighbours neighbour = gather_neighbours(at, replica->effects, batch.motion, partner);
        Memory memory = recall(replica, replica->effects, kept, v);
        const Displaced b = displaced(at, batch, neighbour, v);
        const Contacts c = contact_forces(at, replica->effects, neighbour, b, R(0), &memory);
        add_contact_sums(at, neighbour, b, c, &sums);
        if (replica->finite_contacts) tabulate(c, neighbour.normal, v, table);
        store_vector_rows(c.force, rows.force, 0, v);
        store_slot(c.overlap, rows.overlap, at.row, v);
        store_slot(c.arm, rows.arm, at.row, v);
    }
    return sums;
}

/* Estimate of a grain's highest vibration frequency, sqrt(stiffness/mass) / (1 - gain). The gain of the
   surface displacements is the force that they cause over the force that causes them. It is estimated from
   the root mean squares of b and delta as 2 sqrt(displaced/pressed); the 2 is for both sides of a contact.
   The largest stable time step of the delayed corrections is 0.69 to 0.81 over this frequency, measured up to
   packing fractions of 0.95. */
#define LARGEST_GAIN R(0.9)
INLINE lanes fastest_frequency(lanes mass, lanes stiffness, lanes displaced, lanes pressed) {
    const mask presses = AS_MASK(pressed > R(0));
    const lanes gain = WHERE(presses, R(2) * sqrt(displaced / WHERE(presses, pressed, R(1))), R(0));
    return sqrt(stiffness / mass) / (R(1) - fmin(gain, (lanes)(LARGEST_GAIN)));
}

INLINE lanes kinetic_energy(Grain at) {
    const lanes3 velocity = at.now.velocity, spin = at.now.spin;
    const lanes radius = at.now.radius;
    return R(0.5) * sphere_mass(at, radius) *
           (dot3(velocity, velocity) + R(0.4) * radius * radius * dot3(spin, spin));
}

WORK_GROUP(STEP_ITEMS)
kernel void measure(global const Replica* restrict replicas, global const Material* restrict materials,
                    global const Block* restrict blocks, global const int* restrict steps,
                    global const Motion* restrict motion, global const int* restrict partner,
                    global const int* restrict partner_slot, global const real* restrict displacement,
                    global real* restrict memory, global const Track* restrict track,
                    global real* restrict force, global real* restrict overlap, global real* restrict arm,
                    global real4* restrict energy, global real* restrict frequency) {
    MEMORY_OF_WORK_ITEM
    const Block block = blocks[get_group_id(0)];
    const int r = block.replica, first = FIRST_GRAIN(block);
    global const Replica* restrict replica = replicas + r;
    const Batch batch = {motion, partner, partner_slot, displacement, memory};
    const slots grain = first + LANE_NUMBERS;
    const Grain at = grain_at(replica, materials, r, first, steps[r], load_motion(motion, grain));
    const MeasuredRows rows = {force + force_row(first, 0), overlap, arm};
    const ContactSums sums = measure_contacts(at, batch, rows, table);
    const lanes surfaces = replica->finite_contacts ? surface_energy(at, table) : (lanes)(R(0));
    share(sums.stored, 0, scratch);
    share(sums.deepest, 1, scratch);
    share(sums.stiffness, 2, scratch);
    share(sums.displaced, 3, scratch);
    share(sums.pressed, 4, scratch);
    SYNCHRONISE();
    if (IS_LEADER) {
        const lanes3 moved = way_since_listed(at, track, grain, at.now.position);
        const mask is_grain = AS_MASK(at.now.radius > R(0));
        const lanes4 of_grain = {kinetic_energy(at), sum_slots(sums.stored, 0, scratch) + surfaces,
                                 dot3(moved, moved), max_slots(sums.deepest, 1, scratch)};
        scatter4(of_grain, energy, grain);
        STORE_LANES(WHERE(is_grain,
                          fastest_frequency(
                              sphere_mass(at, at.now.radius), sum_slots(sums.stiffness, 2, scratch),
                              sum_slots(sums.displaced, 3, scratch), sum_slots(sums.pressed, 4, scratch)),
                          R(0)),
                    frequency + first);
    }
}

/* One work-group per portion of a replica. Each work-item sums every 64th grain; a fixed tree combines these
   sums. The host adds the portions in order. */
#define REDUCERS 64
#define SUMS 20 /* kinetic energy, elastic energy, 18 wall force components */

INLINE void add_wall_forces(int grain, global const int* partner, global const real* force, real* sums) {
    for (int c = 0; c < SLOTS; ++c) {
        const int at_wall = partner[SLOT_PLACE(FIRST_SLOT(grain), c)];
        if (at_wall >= NO_PARTNER) continue;
        const int wall = WALL_PARTNER(0) - at_wall;
        for (int axis = 0; axis < 3; ++axis)
            sums[2 + 3 * wall + axis] -= force[SLOT_PLACE(force_row(grain, axis), c)];
    }
}

WORK_GROUP(REDUCERS)
kernel void reduce(global const Replica* restrict replicas, global const Portion* restrict portions,
                   global const int* restrict partner, global const real* restrict force,
                   global const real4* restrict energy, global const real* restrict frequency,
                   global const int* restrict status, global Report* restrict reports) {
    local real shared_sums[REDUCERS][SUMS];
    local real shared_most[REDUCERS][3];
    local int shared_status[REDUCERS][2];
    const Portion portion = portions[get_group_id(0)];
    const int lane = get_local_id(0);
    global const Replica* restrict replica = replicas + portion.replica;
    const int end = min(portion.first + PORTION_GRAINS, replica->grain_count);
    real sums[SUMS];
    for (int q = 0; q < SUMS; ++q) sums[q] = R(0);
    real moved = R(0), deepest = R(0), fastest = R(0);
    int bits = 0, failed = INT_MAX;
    for (int k = portion.first + lane; k < end; k += REDUCERS) {
        const int grain = replica->first_grain + k;
        sums[0] += energy[grain].x;
        sums[1] += energy[grain].y;
        moved = fmax(moved, energy[grain].z);
        deepest = fmax(deepest, energy[grain].w);
        fastest = fmax(fastest, frequency[grain]);
        bits |= status[grain];
        if (status[grain]) failed = min(failed, grain);
        add_wall_forces(grain, partner, force, sums);
    }
    for (int q = 0; q < SUMS; ++q) shared_sums[lane][q] = sums[q];
    shared_most[lane][0] = moved;
    shared_most[lane][1] = deepest;
    shared_most[lane][2] = fastest;
    shared_status[lane][0] = bits;
    shared_status[lane][1] = failed;
    for (int half_way = REDUCERS / 2; half_way > 0; half_way /= 2) {
        barrier(CLK_LOCAL_MEM_FENCE);
        if (lane < half_way) {
            for (int q = 0; q < SUMS; ++q) shared_sums[lane][q] += shared_sums[lane + half_way][q];
            for (int q = 0; q < 3; ++q)
                shared_most[lane][q] = fmax(shared_most[lane][q], shared_most[lane + half_way][q]);
            shared_status[lane][0] |= shared_status[lane + half_way][0];
            shared_status[lane][1] = min(shared_status[lane][1], shared_status[lane + half_way][1]);
        }
    }
    if (lane > 0) return;
    global Report* restrict report = reports + get_group_id(0);
    report->kinetic_energy = shared_sums[0][0];
    report->elastic_energy = shared_sums[0][1];
    for (int q = 0; q < 18; ++q) report->wall_force[q] = shared_sums[0][2 + q];
    report->moved_squared = shared_most[0][0];
    report->deepest_overlap = shared_most[0][1];
    report->frequency = shared_most[0][2];
    report->status = shared_status[0][0];
    report->failed_grain = shared_status[0][1] == INT_MAX ? -1 : shared_status[0][1];
}
