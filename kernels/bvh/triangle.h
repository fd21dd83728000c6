// A ray as the BVHs' tests take it, and the triangle test (docs/spec/bvhs.md, B4).
STRUCT(RayFrame)
{
    Vec3 origin;
    Vec3 inverse; // the depth of one unit along each axis
    Vec3 offset;  // origin * inverse
    uint axis;    // of the direction's largest component
    Vec3 shear;   // the direction times 2^20, its axes in cyclic order and `axis` the third; x and y negated
};

// A vertex as a ray sees it.
STRUCT(Seen)
{
    Sheared at; // the ray is the origin
    real depth; // times 2^40
};

// A ray that does not move along an axis gets a large finite quotient (Aila and Laine 2009).
KERNEL_FN real depth_per_unit(real deepest, real direction)
{
    PRECISE real quotient = deepest / (direction == real(0.0f) ? real(8.27180612553027675e-25f) : direction); // 2^-80
    return quotient;
}

KERNEL_FN RayFrame frame_of(Ray ray)
{
    real deepest = component(ray.direction, deepest_axis(ray.direction));
    RayFrame frame;
    frame.origin = ray.origin;
    frame.axis = deepest_axis(ray.direction);
    Vec3 turned = permuted_from(ray.direction, frame.axis);
    PRECISE real shear_x = turned.x * real(-1048576.0f);
    PRECISE real shear_y = turned.y * real(-1048576.0f);
    PRECISE real shear_z = turned.z * real(1048576.0f);
    frame.shear = VEC3(shear_x, shear_y, shear_z);
    frame.inverse =
        VEC3(depth_per_unit(magnitude(deepest), ray.direction.x), depth_per_unit(magnitude(deepest), ray.direction.y),
             depth_per_unit(magnitude(deepest), ray.direction.z));
    PRECISE real offset_x = ray.origin.x * frame.inverse.x;
    PRECISE real offset_y = ray.origin.y * frame.inverse.y;
    PRECISE real offset_z = ray.origin.z * frame.inverse.z;
    frame.offset = VEC3(offset_x, offset_y, offset_z);
    return frame;
}

// The ray of a frame, exactly: products with powers of two are not rounded. A GPU lacks registers for it in addition to
// the frame.
KERNEL_FN Ray ray_of(RayFrame frame)
{
    PRECISE real a = frame.shear.x * real(-9.5367431640625e-7f); // 2^-20
    PRECISE real b = frame.shear.y * real(-9.5367431640625e-7f);
    PRECISE real c = frame.shear.z * real(9.5367431640625e-7f);
    real x = frame.axis == 0u ? c : frame.axis == 1u ? b : a;
    real y = frame.axis == 0u ? a : frame.axis == 1u ? c : b;
    real z = frame.axis == 0u ? b : frame.axis == 1u ? a : c;
    return make_ray(frame.origin, VEC3(x, y, z));
}

// A vertex is needed only as its two coordinates and its depth: a GPU lacks registers for more of three vertices.
KERNEL_FN Seen seen_by(RayFrame frame, uint4 quad)
{
    Vec3 offset = sub3(VEC3(as_real(quad.x), as_real(quad.y), as_real(quad.z)), frame.origin);
    Vec3 turned = permuted_from(offset, frame.axis);
    real forwards = frame.shear.z < real(0.0f) ? real(-1099511627776.0f) : real(1099511627776.0f); // 2^40
    PRECISE real x = turned.x * frame.shear.z + turned.z * frame.shear.x;
    PRECISE real y = turned.y * frame.shear.z + turned.z * frame.shear.y;
    PRECISE real depth = turned.z * forwards;
    Seen seen;
    seen.at.x = x;
    seen.at.y = y;
    seen.depth = depth;
    return seen;
}

KERNEL_FN bool has_two_signs(real a, real b, real c)
{
    return minimum(minimum(a, b), c) < real(0.0f) && maximum(maximum(a, b), c) > real(0.0f);
}

// The depth of leaf triangle `at`, or NEVER if the ray does not meet it.
// Source: Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013; here without a division.
KERNEL_FN real triangle_depth(SceneView scene, RayFrame frame, uint at)
{
    Seen a = seen_by(frame, FETCH(scene, leaf_triangles, LEAF_TRIANGLE_QUADS * at));
    Seen b = seen_by(frame, FETCH(scene, leaf_triangles, LEAF_TRIANGLE_QUADS * at + 1u));
    Seen c = seen_by(frame, FETCH(scene, leaf_triangles, LEAF_TRIANGLE_QUADS * at + 2u));
    if (has_two_signs(rough_side(b.at, c.at), rough_side(c.at, a.at), rough_side(a.at, b.at))) return NEVER;

    real u = fine_side(b.at, c.at);
    real v = fine_side(c.at, a.at);
    real w = fine_side(a.at, b.at);
    PRECISE real determinant = u + v + w;
    if (has_two_signs(u, v, w) || determinant == real(0.0f)) return NEVER;
    PRECISE real weighted = u * a.depth + v * b.depth + w * c.depth;
    return depth_of_mean(weighted, determinant);
}
