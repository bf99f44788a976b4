/* The family of solids: its rows, and the solids with closed forms. */
#include "base/error.h"
#include "base/memory.h"
#include "generate/solid.h"

#define HEIGHT WR_S_HEIGHT("of its highest place over its middle, as it is turned")

static const WrParam sphere_params[] = {
    WR_S_RADIUS("radius", "Radius", 32, "of the sphere"), WR_S_POSE, HEIGHT, WR_S_PLACE, WR_P_END,
};

static const WrParam ellipsoid_params[] = {
    WR_S_ABOVE("radii", "Radii", 32, 256, "x,y,z", "along its three axes"),
    WR_S_POSE,
    HEIGHT,
    WR_S_PLACE,
    WR_P_END,
};

static const WrParam box_params[] = {
    WR_S_ABOVE("size", "Size", 64, 256, "x,y,z", "its three sides"),
    WR_S_POSE,
    HEIGHT,
    WR_S_PLACE,
    WR_P_END,
};

static const WrParam round_params[] = {
    WR_S_RADIUS("radius", "Radius", 24, "across its axis"),
    WR_S_RADIUS("length", "Length", 64, "along its axis, which stands upright"),
    WR_S_POSE,
    HEIGHT,
    WR_S_PLACE,
    WR_P_END,
};

static const WrParam capsule_params[] = {
    WR_S_RADIUS("radius", "Radius", 16, "of its round ends"),
    WR_S_RADIUS("length", "Length", 96, "from end to end; its axis stands upright"),
    WR_S_POSE,
    HEIGHT,
    WR_S_PLACE,
    WR_P_END,
};

static const WrParam torus_params[] = {
    WR_S_RADIUS("radius", "Radius", 32, "of the ring, to the middle of the tube"),
    WR_S_RADIUS("tube", "Tube", 10, "radius of the tube, less than the ring's"),
    WR_S_POSE,
    HEIGHT,
    WR_S_PLACE,
    WR_P_END,
};

/* ---- drawing ---- */

static bool draw(const WrParams *params, WrZShape shape, double param, const double size[3],
                 const WrGenerateJob *job, WrRelief *out, WrError *err)
{
    WrSolidPlace *places = NULL;
    int64_t count;
    double rise = 1.0;
    if (!wr_solid_places(params, job, &places, &count, err)) return false;
    WrZSolid *solids = wr_try_alloc((size_t)count, sizeof *solids, "solids", err);
    bool good = solids;
    for (int64_t i = 0; good && i < count; i++) {
        const WrSolidPlace *p = &places[i];
        const double scaled[3] = { size[0] * p->scale, size[1] * p->scale, size[2] * p->scale };
        good = wr_zsolid_set(&solids[i], shape, param, NULL, scaled, p->turn, p->at, err);
        if (good && i == 0) rise = wr_zsolid_rise(&solids[0]) / p->scale;
    }
    WrZScene scene = { .solids = solids, .solid_count = count };
    good = good && wr_solid_draw(params, &scene, rise, job, out, err);
    wr_free(solids);
    wr_free(places);
    return good;
}

static bool make_sphere(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                        WrError *err)
{
    const WrParams params = { sphere_params, values };
    double r = wr_param_number(&params, "radius");
    const double size[3] = { r, r, r };
    return draw(&params, WR_Z_SPHERE, 0.0, size, job, out, err);
}

static bool make_ellipsoid(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                           WrError *err)
{
    const WrParams params = { ellipsoid_params, values };
    return draw(&params, WR_Z_SPHERE, 0.0, wr_param_value(&params, "radii")->number, job, out, err);
}

static bool make_box(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                     WrError *err)
{
    const WrParams params = { box_params, values };
    const double *side = wr_param_value(&params, "size")->number;
    const double size[3] = { 0.5 * side[0], 0.5 * side[1], 0.5 * side[2] };
    return draw(&params, WR_Z_BOX, 0.0, size, job, out, err);
}

static bool make_round(const WrParamValue *values, WrZShape shape, const WrGenerateJob *job,
                       WrRelief *out, WrError *err)
{
    const WrParams params = { round_params, values };
    double r = wr_param_number(&params, "radius");
    const double size[3] = { r, r, 0.5 * wr_param_number(&params, "length") };
    return draw(&params, shape, 0.0, size, job, out, err);
}

static bool make_cylinder(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                          WrError *err)
{
    return make_round(values, WR_Z_CYLINDER, job, out, err);
}

static bool make_cone(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                      WrError *err)
{
    return make_round(values, WR_Z_CONE, job, out, err);
}

static bool make_capsule(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                         WrError *err)
{
    const WrParams params = { capsule_params, values };
    double r = wr_param_number(&params, "radius"), length = wr_param_number(&params, "length");
    const double size[3] = { r, r, r };
    if (length < 2.0 * r)
        return wr_fail(err, "solid capsule: length=%g: must be at least twice the radius, %g",
                       length, 2.0 * r);
    return draw(&params, WR_Z_CAPSULE, (0.5 * length - r) / r, size, job, out, err);
}

static bool make_torus(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                       WrError *err)
{
    const WrParams params = { torus_params, values };
    double r = wr_param_number(&params, "radius"), tube = wr_param_number(&params, "tube");
    const double size[3] = { r, r, r };
    if (!(tube < r))
        return wr_fail(err, "solid torus: tube=%g: must be less than the ring's radius, %g", tube,
                       r);
    return draw(&params, WR_Z_TORUS, tube / r, size, job, out, err);
}

#define ROW(n, l, h, p, m)                                                                         \
    {                                                                                              \
        .family = "solid", .name = (n), .label = (l), .help = (h), .blend = "max", .params = (p),  \
        .make = (m)                                                                                \
    }

const WrGenerator wr_solids[] = {
    ROW("sphere", "Sphere", "a sphere let into the ground: rivets, domes", sphere_params,
        make_sphere),
    ROW("ellipsoid", "Ellipsoid", "a sphere stretched along its axes", ellipsoid_params,
        make_ellipsoid),
    ROW("box", "Box", "a block with flat sides", box_params, make_box),
    ROW("cylinder", "Cylinder", "a disc or a rod", round_params, make_cylinder),
    ROW("cone", "Cone", "a cone; its tip points up", round_params, make_cone),
    ROW("torus", "Torus", "a ring; alternate=90 makes links of chains", torus_params, make_torus),
    ROW("capsule", "Capsule", "a rod with round ends", capsule_params, make_capsule),
    ROW("mesh", "Mesh file", "triangles of a file: OBJ, PLY, STL, glTF and others",
        wr_params_solid_mesh, wr_solid_mesh),
    ROW("letters", "Letters", "letters of any font cut out of a plate, in any pose",
        wr_params_solid_letters, wr_solid_letters),
    ROW("surface", "Surface", "any of the surfaces that can be shown, seen from above",
        wr_params_solid_surface, wr_solid_surface),
    { .family = NULL },
};
