// How an image becomes work items: tiles of TILE_WIDTH x tile_height pixels, whose rays share most of their way. A tile
// is a work group, and each of its items is a ray. A launch traces the tiles from first_tile on. core/device/launch.h
// has the same struct for the host.
#ifndef TETRACE_KERNELS_LAUNCH_H
#define TETRACE_KERNELS_LAUNCH_H

#include "kernels/ray.h"

STRUCT(LaunchParams)
{
    TraceParams trace;
    uint divisions;   // of the domain's sides
    uint first_tile;  // row after row of tiles
    uint tile_height; // 4 or 8
    uint part_log2;   // tets in several buffers: each but the last has 2^part_log2 bytes
    DomainBox domain; // here, since a load from the array of lines costs some devices as much as a step
};

STRUCT(Pixel)
{
    uint x;
    uint y;
};

// Bits 0, 2 and 4 of an item's number, packed together.
KERNEL_FN uint even_bits(uint item)
{
    return (item & 1u) | ((item >> 1u) & 2u) | ((item >> 2u) & 4u);
}

// Pixel of an item, along a Morton curve in its tile: the 4, 8, 16 or 32 items that a device executes together are a
// block of pixels. The pixel is outside the image where the tile is cut off.
KERNEL_FN Pixel pixel_of(LaunchParams launch, uint tile, uint item)
{
    uint tiles_x = (launch.trace.width + (TILE_WIDTH - 1u)) / TILE_WIDTH;
    Pixel pixel;
    pixel.x = tile % tiles_x * TILE_WIDTH + even_bits(item);
    pixel.y = tile / tiles_x * launch.tile_height + even_bits(item >> 1u);
    return pixel;
}

KERNEL_FN bool is_in_image(LaunchParams launch, Pixel pixel)
{
    return pixel.x < launch.trace.width && pixel.y < launch.trace.height;
}

// First word of a pixel's hit in the output, which has guard words before and after the hits.
KERNEL_FN uint output_word(LaunchParams launch, Pixel pixel)
{
    return GUARD_WORDS + HIT_WORDS * (pixel.y * launch.trace.width + pixel.x);
}

// Number of an item's ray where rays are given. The image is then one tile wide.
KERNEL_FN uint ray_index(Pixel pixel)
{
    return pixel.y * TILE_WIDTH + pixel.x;
}

// Number of rays. Quad r of ray i is number r * ray_count() + i.
KERNEL_FN uint ray_count(LaunchParams launch)
{
    return launch.trace.height * TILE_WIDTH;
}

#endif
