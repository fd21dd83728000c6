// walks/: the walks from tet to tet, one file each, and how rays enter the domain. This file:
// task absorb, a medium that glows and absorbs, with a value and a density per tet, front to back, in integers alone
// (docs/spec/volume.md, S11).
#ifndef TETRACE_KERNELS_WALKS_ABSORPTION_H
#define TETRACE_KERNELS_WALKS_ABSORPTION_H

// From the tet's number, since scenes have no such data. density: in 16ths of a halving of the light per domain unit;
// value: the light of a tet that lets nothing pass, in 256ths. Both are 0 to 255. A build that tests another medium
// defines its own.
#ifndef DENSITY_OF
#define DENSITY_OF(tet) (medium_word(tet) >> 24u)
#define VALUE_OF(tet) ((medium_word(tet) >> 16u) & 255u)
#endif

KERNEL_FN uint medium_word(uint tet)
{
    uint mixed = (tet + 1u) * 0x9E3779B1u;
    return (mixed ^ (mixed >> 15u)) * 0x85EBCA6Bu;
}

// What a ray has met so far.
STRUCT(Absorption)
{
    uint halvings;      // depth of the medium, of which each whole one halves the light
    uint fraction;      // the rest of it, in units of 2^-32
    uint transmittance; // 2^-depth, in units of 2^-TRANSMITTANCE_BITS
    uint light;         // that reaches the ray's beginning, in units of 2^-(8 + TRANSMITTANCE_BITS)
};

KERNEL_FN Absorption no_absorption()
{
    Absorption none;
    none.halvings = 0u;
    none.fraction = 0u;
    none.transmittance = NO_ABSORPTION;
    none.light = 0u;
    return none;
}

// 2^-depth, off by less than 1.1 units, and never larger for a larger depth: a polynomial of the first 24 bits of the
// fraction f, 1 - f (c1 - f (c2 - ...)), whose coefficients are in units of 2^-32. All products are of positive
// numbers.
KERNEL_FN uint transmittance_of(uint halvings, uint fraction)
{
    uint f = fraction & 0xFFFFFF00u;
    uint rest = 0x54A612u - high_product(f, 0x78809u);
    rest = 0x274F388u - high_product(f, rest);
    rest = 0xE353290u - high_product(f, rest);
    rest = 0x3D7F7506u - high_product(f, rest);
    rest = 0xB17217DFu - high_product(f, rest);
    uint power = (0x80000000u - (high_product(f, rest) >> 1u)) >> (31u - TRANSMITTANCE_BITS);
    return halvings > TRANSMITTANCE_BITS ? 0u : power >> halvings;
}

// After a length inside a tet, in units of 2^-LENGTH_BITS: density times length is in units of 2^-32.
KERNEL_FN Absorption absorbed_in(uint tet, uint length, Absorption before)
{
    uint density = DENSITY_OF(tet);
    Absorption after = before;
    after.fraction = before.fraction + density * length;
    uint carry = after.fraction < before.fraction ? 1u : 0u;
    after.halvings = before.halvings + high_product(density, length) + carry;
    after.transmittance = transmittance_of(after.halvings, after.fraction);
    after.light = before.light + VALUE_OF(tet) * (before.transmittance - after.transmittance);
    return after;
}

#endif
