// What every kernel has before its own text: the functions that kernels/language/dialect_wgsl.h declares, and those that
// make arithmetic exact. WGSL promises no order of operations, no correctly rounded division, and lets a compiler
// contract; Metal and DXC use that.

var<private> zero: u32; // 0, from a buffer, so that no compiler knows it

// x, rounded: nothing can be moved, joined or left out across it.
fn keep(x: f32) -> f32 {
    return bitcast<f32>(bitcast<u32>(x) ^ zero);
}

// The upper 12 bits of x (Veltkamp 1968).
fn upper_half(x: f32) -> f32 {
    let large = keep(x * 4097.0f);
    return keep(large - keep(large - x));
}

// a / b, correctly rounded, from a quotient that may be a few units off: the sign and the size of the exact remainder
// a - q b (Dekker 1971) say whether a neighbour is nearer. Where the remainder may not be exact, the device's own
// quotient: |q| or |b| outside of 2^-60 to 2^64.
fn divided(a: f32, b: f32) -> f32 {
    var q: f32 = keep(a / b);
    if (!(abs(q) > 8.673617379884035e-19f && abs(q) < 1.8446744073709552e19f && abs(b) > 8.673617379884035e-19f && abs(b) < 1.8446744073709552e19f)) {
        return q;
    }
    let b_high = upper_half(b);
    let b_low = keep(b - b_high);
    for (var i: u32 = 0u; i < 4u; i += 1u) {
        let product = keep(q * b);
        let q_high = upper_half(q);
        let q_low = keep(q - q_high);
        let high = keep(keep(q_high * b_high) - product);
        let middle = keep(keep(high + keep(q_high * b_low)) + keep(q_low * b_high));
        let lost = keep(middle + keep(q_low * b_low)); // q b - product
        let rest = keep(keep(a - product) - lost);
        let bits = bitcast<u32>(q);
        let grows = ((bitcast<u32>(rest) ^ bitcast<u32>(b) ^ bits) >> 31u) == 0u; // q is too small in magnitude
        // Half a unit of q's last place; a quarter below a power of 2.
        let half_exponent = (bits & 0x7F800000u) - (24u << 23u);
        let half_unit = bitcast<f32>(select(half_exponent, half_exponent - (1u << 23u), (bits & 0x007FFFFFu) == 0u && !grows));
        if (abs(rest) <= keep(half_unit * abs(b))) {
            break;
        }
        q = bitcast<f32>(select(bits - 1u, bits + 1u, grows));
    }
    return q;
}

fn as_real(bits: u32) -> f32 {
    return bitcast<f32>(bits);
}
fn as_bits(value: f32) -> u32 {
    return bitcast<u32>(value);
}
fn magnitude(value: f32) -> f32 {
    return abs(value);
}
fn to_real(value: u32) -> f32 {
    return f32(value);
}
fn to_uint(value: f32) -> u32 {
    return u32(value);
}
fn square_root(value: f32) -> f32 {
    return sqrt(value);
}
fn multiply_add(a: f32, b: f32, c: f32) -> f32 {
    return a * b + c;
}
fn minimum(a: f32, b: f32) -> f32 {
    return min(a, b);
}
fn maximum(a: f32, b: f32) -> f32 {
    return max(a, b);
}
fn highest_bit(value: u32) -> u32 {
    return firstLeadingBit(value);
}
fn bit_count(value: u32) -> u32 {
    return countOneBits(value);
}
fn high_product(a: u32, b: u32) -> u32 {
    let low = (a & 0xFFFFu) * (b & 0xFFFFu);
    let middle = (a >> 16u) * (b & 0xFFFFu) + (low >> 16u);
    let other = (a & 0xFFFFu) * (b >> 16u) + (middle & 0xFFFFu);
    return (a >> 16u) * (b >> 16u) + (middle >> 16u) + (other >> 16u);
}
