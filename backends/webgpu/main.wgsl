
override tile_height: u32 = 8u;
@compute @workgroup_size(8, tile_height)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) item: u32) {
    zero = launch_words.zero;
    run_item(group.x, item);
}
