// Sorts the particles into cells, water first; within a cell by their index on the host, so that no race
// decides the order.
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read_write> places: array<Place>;
@group(0) @binding(3) var<storage, read_write> motion: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read_write> before: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> positions: array<vec4<i32>>;
@group(0) @binding(6) var<storage, read_write> velocities: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> count: array<atomic<u32>>;
@group(0) @binding(8) var<storage, read_write> start: array<u32>;
@group(0) @binding(9) var<storage, read_write> blocks: array<u32>;
@group(0) @binding(10) var<storage, read_write> order: array<u32>;
@group(0) @binding(11) var<storage, read_write> slot: array<u32>;
@group(0) @binding(12) var<storage, read_write> spare_places: array<Place>;
@group(0) @binding(13) var<storage, read_write> spare: array<vec4<f32>>;
@group(0) @binding(14) var<storage, read_write> built: array<vec4<i32>>;
@group(0) @binding(15) var<storage, read_write> rows: array<f32>;
@group(0) @binding(16) var<storage, read_write> spare_rows: array<f32>;

fn cell(i: u32) -> u32 {
    return row_at(cell_of(places[i].hi), 0, 0) + 2u + select(0u, params.cells, i >= params.water);
}

// The cell of an image.
fn image_cell(i: u32, way: u32) -> u32 {
    return row_at(cell_of(away(places[i], way).hi), 0, 0) + 2u + 2u * params.cells;
}

// Once before each pass: whether something has moved so far that the lists may miss a pair.
@compute @workgroup_size(1)
fn decide() {
    control.rebuild = select(0u, 1u, control.halt == 0u && atomicLoad(&control.moved2) >= MARGIN2);
    if (REMOVES && control.rebuild != 0u) { control.renewed = 1u; }
    if (control.halt == 0u) {
        control.passes += 1u;
        control.age += 1u;
        control.correct = select(0u, 1u, control.rebuild != 0u || control.age >= CORRECT_EVERY);
        if (control.correct != 0u) { control.age = 0u; }
        atomicStore(&control.moved2, 0u);
        atomicStore(&control.force2, 0u);
        atomicStore(&control.approach, 0u);
    }
}

@compute @workgroup_size(128)
fn clear(@builtin(global_invocation_id) id: vec3<u32>) {
    if (control.rebuild == 0u) { return; }
    let i = index(id);
    if (i <= KINDS * params.cells) { atomicStore(&count[i], 0u); }
}

@compute @workgroup_size(128)
fn tally(@builtin(global_invocation_id) id: vec3<u32>) {
    if (control.rebuild == 0u) { return; }
    let i = index(id);
    if (i >= params.n) { return; }
    if (PERIODIC && i < params.water) {
        let way = way_in(places[i]);
        if (way != 0u) {
            places[i] = away(places[i], way);
            positions[i] = vec4<i32>(middle(places[i]), positions[i].w);
            if (REFLECTS) {
                motion[i] = vec4<f32>(reflected(motion[i].xyz, way), motion[i].w);
                velocities[i] = vec4<f32>(reflected(velocities[i].xyz, way), velocities[i].w);
                if (VERLET) { before[i] = vec4<f32>(reflected(before[i].xyz, way), before[i].w); }
                for (var row = 0u; row < KEPT_ROWS; row++) { rows[row * params.slots + i] *= row_sign(row, way); }
            }
        }
        for (var other = 1u; other < WAYS; other++) {
            if (has_image(places[i], other)) { atomicAdd(&count[image_cell(i, other)], 1u); }
        }
    }
    atomicAdd(&count[cell(i)], 1u);
}

const BLOCK: u32 = 1024u;
var<workgroup> part: array<u32, 128>;

// Exclusive sums within blocks of 1024, and the sums of the blocks.
@compute @workgroup_size(128)
fn scan(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) l: u32) {
    let total = select(0u, KINDS * params.cells + 1u, control.rebuild != 0u);
    let block = group_index(group);
    let first = block * BLOCK + l * 8u;
    var own = 0u;
    for (var k = 0u; k < 8u; k++) {
        if (first + k < total) { own += atomicLoad(&count[first + k]); }
    }
    part[l] = own;
    workgroupBarrier();
    for (var step = 1u; step < 128u; step *= 2u) {
        var add = 0u;
        if (l >= step) { add = part[l - step]; }
        workgroupBarrier();
        part[l] += add;
        workgroupBarrier();
    }
    var sum = part[l] - own;
    for (var k = 0u; k < 8u; k++) {
        if (first + k < total) {
            let c = atomicLoad(&count[first + k]);
            start[first + k] = sum;
            sum += c;
            atomicStore(&count[first + k], 0u);
        }
    }
    if (l == 127u && block * BLOCK < total) { blocks[block] = part[127]; }
}

// Exclusive sums of the blocks, by one workgroup.
@compute @workgroup_size(128)
fn scan_blocks(@builtin(local_invocation_index) l: u32) {
    let total = (KINDS * params.cells + BLOCK) / BLOCK;
    var sums_before = 0u;
    for (var first = 0u; first < total; first += 128u) {
        var own = 0u;
        if (first + l < total) { own = blocks[first + l]; }
        part[l] = own;
        workgroupBarrier();
        for (var step = 1u; step < 128u; step *= 2u) {
            var add = 0u;
            if (l >= step) { add = part[l - step]; }
            workgroupBarrier();
            part[l] += add;
            workgroupBarrier();
        }
        if (control.rebuild != 0u && first + l < total) { blocks[first + l] = sums_before + part[l] - own; }
        sums_before += part[127];
        workgroupBarrier();
    }
}

@compute @workgroup_size(128)
fn scan_add(@builtin(global_invocation_id) id: vec3<u32>) {
    if (control.rebuild == 0u) { return; }
    let i = index(id);
    if (i <= KINDS * params.cells) { start[i] += blocks[i / BLOCK]; }
}

@compute @workgroup_size(128)
fn scatter(@builtin(global_invocation_id) id: vec3<u32>) {
    if (control.rebuild == 0u) { return; }
    let i = index(id);
    if (i >= params.n) { return; }
    let c = cell(i);
    order[start[c] + atomicAdd(&count[c], 1u)] = i;
    if (PERIODIC && i < params.water) {
        for (var way = 1u; way < WAYS; way++) {
            if (has_image(places[i], way)) {
                let other = image_cell(i, way);
                order[start[other] + atomicAdd(&count[other], 1u)] = i * WAYS + way;
            }
        }
    }
}

// What decides the order within a cell: the index on the host, and the way of an image.
fn key(k: u32) -> u32 {
    let entry = order[k];
    if (!PERIODIC || k < params.n) { return u32(places[entry].hi.w); }
    return u32(places[entry / WAYS].hi.w) * WAYS + entry % WAYS;
}

// The atomics of before decided the order within a cell; now the key does.
@compute @workgroup_size(128)
fn settle(@builtin(global_invocation_id) id: vec3<u32>) {
    if (control.rebuild == 0u) { return; }
    let c = index(id);
    if (c >= KINDS * params.cells) { return; }
    let first = start[c];
    for (var k = first + 1u; k < start[c + 1u]; k++) {
        let mine = order[k];
        let own = key(k);
        var m = k;
        while (m > first && key(m - 1u) > own) {
            order[m] = order[m - 1u];
            m -= 1u;
        }
        order[m] = mine;
    }
}

@compute @workgroup_size(128)
fn gather(@builtin(global_invocation_id) id: vec3<u32>) {
    if (control.rebuild == 0u) { return; }
    let k = index(id);
    if (PERIODIC && k >= params.n && k < start[KINDS * params.cells]) { order[k] = key(k); }
    if (k >= params.n) { return; }
    let i = order[k];
    spare_places[k] = places[i];
    spare[k] = motion[i];
    spare[params.n + k] = velocities[i];
    spare[2u * params.n + k] = bitcast<vec4<f32>>(positions[i]);
    if (VERLET) { spare[3u * params.n + k] = before[i]; }
    for (var row = 0u; row < KEPT_ROWS; row++) { spare_rows[row * params.n + k] = rows[row * params.slots + i]; }
}

@compute @workgroup_size(128)
fn put_back(@builtin(global_invocation_id) id: vec3<u32>) {
    if (control.rebuild == 0u) { return; }
    let k = index(id);
    if (k >= params.n) { return; }
    let place = spare_places[k];
    let position = bitcast<vec4<i32>>(spare[2u * params.n + k]);
    places[k] = place;
    motion[k] = spare[k];
    velocities[k] = spare[params.n + k];
    positions[k] = position;
    built[k] = position;
    slot[u32(place.hi.w)] = k;
    if (VERLET) { before[k] = spare[3u * params.n + k]; }
    for (var row = 0u; row < KEPT_ROWS; row++) { rows[row * params.slots + k] = spare_rows[row * params.n + k]; }
}
