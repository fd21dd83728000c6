// Persistent warps whose lanes fetch rays for themselves: if few of a warp's lanes still have a ray, the others write
// their hits and start new rays, while those few are still on their way.
//
// Source: Aila and Laine, "Understanding the Efficiency of Ray Traversal on GPUs", HPG 2009, section 3.3, and its
// addendum with Karras, 2012, in whose released kernel for Kepler "few" is less than 20 of 32. There, the lanes in the
// loop vote; here, all lanes of a warp stay in the loop, because with independently scheduled lanes (since Volta) a
// vote waits only for the lanes that it names.
#ifndef TETRACE_KERNELS_REFILL_CUDA_H
#define TETRACE_KERNELS_REFILL_CUDA_H

#define REFILLS_LANES

#define WHOLE_WARP 0xFFFFFFFFu
#ifndef ENOUGH_LANES                             // a test has fewer
#define ENOUGH_LANES ((5u * warpSize + 7u) / 8u) // 20 of 32
#endif
#define NO_ITEM 0xFFFFFFFFu

// Takes `count` numbers from the counter. Returns the first, to the whole warp.
KERNEL_FN uint fetch_items(uint count, uint* counter)
{
    uint first = 0u;
    if (threadIdx.x % warpSize == 0u) first = atomicAdd(counter, count);
    return __shfl_sync(WHOLE_WARP, first, 0);
}

// Traces rays until all are traced. Rays: those of a launch by number, as backends/cuda/kernel.cu has them. counter: 0
// at first. begin(item): begins a ray; returns whether it goes on. go_on(going): goes on with it, together with the
// lanes `going`; returns whether it then goes on. hit(item): of a ray that does not.
template <class Rays, class Begin, class GoOn, class HitOf>
KERNEL_FN void refill_lanes(const Rays& rays, uint* counter, Begin begin, GoOn go_on, HitOf hit)
{
    uint item = NO_ITEM; // the lane's ray, whose hit is not written yet
    bool goes_on = false;
    bool any_left = true; // of the rays that no lane has
    for (;;) {
        uint going = __ballot_sync(WHOLE_WARP, goes_on);
        if (bit_count(going) < (any_left ? ENOUGH_LANES : 1u)) {
            if (!goes_on && item != NO_ITEM) rays.write(item, hit(item));
            if (!any_left) return;
            uint first = fetch_items(warpSize - bit_count(going), counter);
            any_left = first + warpSize - bit_count(going) < rays.items();
            if (!goes_on) {
                uint lane = threadIdx.x % warpSize;
                item = first + lane - bit_count(going & ((1u << lane) - 1u));
                goes_on = rays.has(item);
                if (goes_on) {
                    goes_on = begin(item);
                } else {
                    item = NO_ITEM;
                }
            }
            going = __ballot_sync(WHOLE_WARP, goes_on);
        }
        if (goes_on) goes_on = go_on(going);
    }
}

#endif
