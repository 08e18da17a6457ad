/* Kernel `cell_stress`: the stress of a fully periodic cell times its volume, minus the sum over contacts of
   branch vector times force (Love-Weber formula). Each contact occupies two slots, so each slot adds half of
   its product. One work-group sums one portion of a replica, as in `reduce`. */

#define STRESS_SUMS 9

WORK_GROUP(REDUCERS)
kernel void cell_stress(global const Replica* restrict replicas, global const Portion* restrict portions,
                        global const int* restrict steps, global const Motion* restrict motion,
                        global const int* restrict partner, global const real* restrict forces,
                        global real* restrict moments) {
    local real shared[REDUCERS][STRESS_SUMS];
    const Portion portion = portions[get_group_id(0)];
    const int lane = get_local_id(0);
    global const Replica* restrict replica = replicas + portion.replica;
    const bool is_cell = replica->container == CONTAINER_CELL;
    const int end = is_cell ? min(portion.first + PORTION_GRAINS, replica->grain_count) : 0;
    const Deformation f = deformation(replica, replica->time_step * steps[portion.replica]);
    real sums[STRESS_SUMS];
    for (int q = 0; q < STRESS_SUMS; ++q) sums[q] = R(0);
    for (int k = portion.first + lane; k < end; k += REDUCERS) {
        const int grain = replica->first_grain + k;
        for (int c = 0; c < SLOTS; ++c) {
            const int other = partner[SLOT_PLACE(FIRST_SLOT(grain), c)];
            const real3 force = (real3)(forces[SLOT_PLACE(force_row(grain, 0), c)],
                                        forces[SLOT_PLACE(force_row(grain, 1), c)],
                                        forces[SLOT_PLACE(force_row(grain, 2), c)]);
            if (other < 0 || (force.x == R(0) && force.y == R(0) && force.z == R(0))) continue;
            const real3 listed = motion[other].position.xyz - motion[grain].position.xyz;
            const real3 half_branch = R(0.5) * deformed(f, nearest_in_cell(replica, f, listed));
            const real3 x = half_branch.x * force, y = half_branch.y * force, z = half_branch.z * force;
            sums[0] -= x.x, sums[1] -= x.y, sums[2] -= x.z;
            sums[3] -= y.x, sums[4] -= y.y, sums[5] -= y.z;
            sums[6] -= z.x, sums[7] -= z.y, sums[8] -= z.z;
        }
    }
    for (int q = 0; q < STRESS_SUMS; ++q) shared[lane][q] = sums[q];
    for (int half_way = REDUCERS / 2; half_way > 0; half_way /= 2) {
        barrier(CLK_LOCAL_MEM_FENCE);
        if (lane < half_way)
            for (int q = 0; q < STRESS_SUMS; ++q) shared[lane][q] += shared[lane + half_way][q];
    }
    if (lane > 0) return;
    for (int q = 0; q < STRESS_SUMS; ++q) moments[get_group_id(0) * STRESS_SUMS + q] = shared[0][q];
}
