// The end of a text that wgsl_as_cpp rewrote: its one function for tests, of the name WGSL_ENTRY.

/// Runs an item of a work group. buffers: by binding.
void WGSL_ENTRY(std::span<const Bytes> buffers, u32 group, u32 item)
{
    for (u32 binding = 0; binding < buffers.size(); ++binding)
        if (!buffers[binding].empty()) set(binding, buffers[binding]);
    zero = launch_words.zero;
    run_item(group, item);
}
