// Gather, acceleration, contact projection, integration and book-keeping of every node.

@group(0) @binding(5) var<uniform> step: Step;
@group(0) @binding(9) var<storage, read_write> works: array<vec4f>;

// (internal, body force, damping) of this step [J].
fn node_works(node: Node, f_int: vec3f, v: vec3f, after: vec3f, way: vec3f) -> vec4f {
    return vec4f(-dot(f_int, way), node.mass * dot(gravity(), way), damping_work(node.mass, v, after, way), 0.0);
}

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let n = thread_index(group, groups, lane);
    if n >= arrayLength(&nodes) {
        return;
    }
    let node = nodes[n];
    let f_int = moving(n, gather(n));
    let x = load_position(n);
    let v = velocities[n].xyz;
    let moved = move_node(node, f_int, x, v);
    let way = step.weight_before * v + step.weight_after * moved.v;
    let rim = is_rim(node.role);
    works[n] += node_works(node, f_int, v, moved.v, way) * vec4f(1.0, 1.0, select(1.0, 0.0, rim), 0.0);
    if rim {
        book_rim(node, f_int, x, v, moved, way);
    } else {
        book_contact(node.role, moved, way);
    }
    store_position(n, moved, rim);
    velocities[n] = vec4f(moved.v, 0.0);
    // The last thing a submission does: the host looks for it.
    if n == 0u {
        done[0] = step.index;
    }
}
