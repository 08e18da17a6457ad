/* Kernels `measure` and `reduce`: the state at the end of an interval of steps. `measure` computes the force,
   overlap and arm of every slot, and the energies and the longest stable step of every grain. `reduce`
   computes sums and maxima over each portion of a replica, in a fixed order. */

/* Sums (and a maximum) over a grain's contacts, and its contacts for small motions. */
typedef struct {
    lanes stored;  /* energy of contacts [J] */
    lanes springs; /* energy of tangential and rolling springs [J] */
    lanes deepest; /* largest corrected overlap over overlap_scale() */
    lanes3 force, torque;
    Power power;
    Tensor stiffness; /* sum of w (k_n n n + k_t (1 - n n)) [N/m] (stable_step.h) */
    ContactStiffness slot[SLOTS_HERE];
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

INLINE void add_contact_sums(Grain at, Neighbours neighbour, Displaced b, slots partner, Contacts c, int v,
                             ContactSums* restrict sums) {
    const int effects = at.replica->effects;
    const lanes3 n = neighbour.normal;
    sums->stored += elastic_energy(at, effects, neighbour, c);
    sums->springs += WHERE(neighbour.wall, R(1), R(0.5)) * c.spring_energy;
    sums->deepest =
        fmax(sums->deepest, WHERE(neighbour.occupied, c.overlap / overlap_scale(at, neighbour), R(0)));
    add_contacts(c, n, &sums->force, &sums->torque);
    if (effects & EFFECT_ROLLING_RESISTANCE) sums->torque = add3(sums->torque, c.couple);
    add_power(at, neighbour, partner, c, &sums->power);
    const ContactStiffness s = contact_stiffness(at, neighbour, b, c);
    sums->slot[v] = s;
    sums->stiffness = add_tensors(sums->stiffness, axial_tensor(s.shear, s.normal - s.shear, n));
}

/* Fields that measure() writes, one value per slot; `force`: the three rows of this work-item. */
typedef struct {
    global real *force, *overlap, *arm;
} MeasuredRows;

/* The field `force` has three rows for the grains of a work-item, one per axis. */
INLINE size_t force_row(int grain, int axis) {
    return ((size_t)(grain / LANES) * 3 + axis) * (LANES * SLOTS) + grain % LANES;
}

INLINE void measure_contacts(Grain at, Batch batch, MeasuredRows rows, EXCHANGE ContactTable* table,
                             ContactSums* restrict sums) {
    global const Replica* restrict replica = at.replica;
    global real* kept = memory_of(at, batch.memory);
    for (int v = 0; v < at.count; ++v) {
        const slots partner = load_number(batch.partner, at.row, v);
        const Neighbours neighbour = gather_neighbours(at, replica->effects, batch.motion, partner);
        Memory memory = recall(replica, replica->effects, kept, v);
        const Displaced b = displaced(at, batch, neighbour, v);
        const Contacts c = contact_forces(at, replica->effects, neighbour, b, R(0), &memory);
        add_contact_sums(at, neighbour, b, partner, c, v, sums);
        tabulate(c, neighbour.normal, v, table);
        store_vector_rows(c.force, rows.force, 0, v);
        store_slot(c.overlap, rows.overlap, at.row, v);
        store_slot(c.arm, rows.arm, at.row, v);
    }
}

/* Sums of vectors and tensors over the slots of a grain, for all of its work-items. */
INLINE lanes3 whole_vector(lanes3 value, EXCHANGE real* scratch) {
    SYNCHRONISE();
    share(value.x, 0, scratch);
    share(value.y, 1, scratch);
    share(value.z, 2, scratch);
    SYNCHRONISE();
    return (lanes3){sum_slots(value.x, 0, scratch), sum_slots(value.y, 1, scratch),
                    sum_slots(value.z, 2, scratch)};
}
INLINE Tensor whole_tensor(Tensor value, EXCHANGE real* scratch) {
    const lanes3 diagonal = whole_vector((lanes3){value.xx, value.yy, value.zz}, scratch);
    const lanes3 mixed = whole_vector((lanes3){value.yz, value.xz, value.xy}, scratch);
    return (Tensor){diagonal.x, diagonal.y, diagonal.z, mixed.x, mixed.y, mixed.z};
}

/* Kinetic energy at the time of the positions: velocities are half a step behind, so half a step of
   acceleration is added. */
INLINE lanes kinetic_energy(Grain at, lanes3 force, lanes3 torque) {
    Moving later = integrate(at, force, torque);
    const lanes3 velocity = scale3(R(0.5), add3(at.now.velocity, later.velocity)),
                 spin = scale3(R(0.5), add3(at.now.spin, later.spin));
    const lanes radius = at.now.radius;
    return R(0.5) * sphere_mass(at, radius) *
           (dot3(velocity, velocity) + R(0.4) * radius * radius * dot3(spin, spin));
}

/* Work of the weight during a displacement [J]. */
INLINE lanes weight_work(Grain at, lanes3 moved) {
    return -OWN(at, weight_density) / OWN(at, density) * sphere_mass(at, at.now.radius) * moved.z;
}

WORK_GROUP(STEP_ITEMS)
kernel void measure(global const Replica* restrict replicas, global const Material* restrict materials,
                    global const Block* restrict blocks, global const int* restrict steps,
                    global const Motion* restrict motion, global const int* restrict partner,
                    global const int* restrict partner_slot, global const real* restrict displacement,
                    global real* restrict memory, global Track* restrict track, global real* restrict force,
                    global real* restrict overlap, global real* restrict arm, global real4* restrict energy) {
    MEMORY_OF_WORK_ITEM
    const Block block = blocks[get_group_id(0)];
    const int r = block.replica, first = FIRST_GRAIN(block);
    global const Replica* restrict replica = replicas + r;
    const Batch batch = {motion, partner, partner_slot, displacement, memory};
    const slots grain = first + LANE_NUMBERS;
    const Grain at = grain_at(replica, materials, r, first, steps[r], load_motion(motion, grain));
    const MeasuredRows rows = {force + force_row(first, 0), overlap, arm};
    ContactSums sums = {
        R(0), R(0), R(0), ZERO3, ZERO3, {R(0), R(0), R(0)}, {R(0), R(0), R(0), R(0), R(0), R(0)}};
    measure_contacts(at, batch, rows, table, &sums);
    const lanes3 total_force = whole_vector(sums.force, scratch), torque = whole_vector(sums.torque, scratch);
    const lanes3 axis = main_axis(whole_tensor(sums.stiffness, scratch));
    const AxialSums motion_sums = axial_sums(at, sums.slot, axis, table);
    const lanes surfaces = replica->finite_contacts ? surface_energy(at, table) : (lanes)(R(0));
    SYNCHRONISE();
    share(sums.stored, 0, scratch);
    share(sums.deepest, 1, scratch);
    share(sums.springs, 2, scratch);
    share(motion_sums.stiffness, 3, scratch);
    share(motion_sums.damping, 4, scratch);
    share(motion_sums.displaced, 5, scratch);
    share(motion_sums.shear, 6, scratch);
    share(motion_sums.shear_damping, 7, scratch);
    share(sums.power.driven, 8, scratch);
    share(sums.power.damped, 9, scratch);
    SYNCHRONISE();
    if (IS_LEADER) {
        const lanes3 moved = way_since_listed(at, track, grain, at.now.position);
        const mask is_grain = AS_MASK(at.now.radius > R(0));
        const AxialSums whole = {
            sum_slots(motion_sums.stiffness, 3, scratch), sum_slots(motion_sums.shear, 6, scratch),
            sum_slots(motion_sums.damping, 4, scratch), sum_slots(motion_sums.shear_damping, 7, scratch),
            sum_slots(motion_sums.displaced, 5, scratch)};
        const lanes4 first_four = {kinetic_energy(at, total_force, torque),
                                   sum_slots(sums.stored, 0, scratch) + surfaces, dot3(moved, moved),
                                   max_slots(sums.deepest, 1, scratch)};
        const lanes4 last_four = {weight_work(at, moved), sum_slots(sums.springs, 2, scratch),
                                  WHERE(is_grain, step_rate(sphere_mass(at, at.now.radius), whole), R(0)),
                                  R(0)};
        global real4* works = (global real4*)track + 2;
        lanes4 work = gather4(works, grain * TRACK_VECTORS);
        work.x += R(0.5) * replica->time_step * sum_slots(sums.power.driven, 8, scratch);
        work.y += R(0.5) * replica->time_step * sum_slots(sums.power.damped, 9, scratch);
        scatter4(work, works, grain * TRACK_VECTORS);
        scatter4(first_four, energy, 2 * grain);
        scatter4(last_four, energy + 1, 2 * grain);
    }
}

/* One work-group per portion of a replica. Each work-item sums every 64th grain; a fixed tree combines these
   sums. The host adds the portions in order. */
#define REDUCERS 64
#define SUMS 26 /* four energies, four works, 18 components of wall forces */

INLINE void add_wall_forces(int grain, global const int* partner, global const real* force, real* sums) {
    for (int c = 0; c < SLOTS; ++c) {
        const int at_wall = partner[SLOT_PLACE(FIRST_SLOT(grain), c)];
        if (at_wall >= NO_PARTNER) continue;
        const int wall = WALL_PARTNER(0) - at_wall;
        for (int axis = 0; axis < 3; ++axis)
            sums[8 + 3 * wall + axis] -= force[SLOT_PLACE(force_row(grain, axis), c)];
    }
}

WORK_GROUP(REDUCERS)
kernel void reduce(global const Replica* restrict replicas, global const Portion* restrict portions,
                   global const int* restrict partner, global const real* restrict force,
                   global const real4* restrict energy, global const Track* restrict track,
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
        const real4 first = energy[2 * grain], last = energy[2 * grain + 1], work = track[grain].work;
        sums[0] += first.x;
        sums[1] += first.y;
        sums[2] += last.x;
        sums[3] += last.y;
        sums[4] += work.x;
        sums[5] += work.y;
        sums[6] += work.z;
        sums[7] += work.w;
        moved = fmax(moved, first.z);
        deepest = fmax(deepest, first.w);
        fastest = fmax(fastest, last.z);
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
    report->weight_work = shared_sums[0][2];
    report->spring_energy = shared_sums[0][3];
    report->work = shared_sums[0][4];
    report->damped = shared_sums[0][5];
    report->rubbed = shared_sums[0][6];
    report->dragged = shared_sums[0][7];
    for (int q = 0; q < 18; ++q) report->wall_force[q] = shared_sums[0][8 + q];
    report->moved_squared = shared_most[0][0];
    report->deepest_overlap = shared_most[0][1];
    report->step_rate = shared_most[0][2];
    report->status = shared_status[0][0];
    report->failed_grain = shared_status[0][1] == INT_MAX ? -1 : shared_status[0][1];
}
