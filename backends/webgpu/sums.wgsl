// Task tally: the sums of the tets, two words each. The binding is sums_binding of kernels.h.
@group(0) @binding(17) var<storage, read_write> sums: array<atomic<u32>>;

// What the word was.
fn add_to_sum(word: u32, added: u32) -> u32 {
    return atomicAdd(&sums[word], added);
}

