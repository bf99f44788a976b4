/* Hard cases of meshes: shared functions, and (u,v) with zero, almost zero or mirrored area. */
#include "hardcases/hardcases_frames.h"

#include "base/error.h"
#include "field/scheme_list.h"
#include "base/memory.h"
#include "field/field.h"
#include "hardcases/hardcases_later.h"
#include "scene/scene.h"

#include <string.h>

/* ---- shared functions ---- */

WrTriangles *wr_hard_triangles(const WrHardMesh *mesh, WrError *err)
{
    float points[WR_HARD_CORNERS][3], normals[WR_HARD_CORNERS][3], uv[WR_HARD_CORNERS][2];
    for (int i = 0; i < mesh->corners; i++) {
        memcpy(points[i], mesh->corner[i].p, sizeof points[i]);
        memcpy(normals[i], mesh->corner[i].n, sizeof normals[i]);
        uv[i][0] = mesh->corner[i].u, uv[i][1] = mesh->corner[i].v;
    }
    const WrTrianglesSource source = { .points = (const float(*)[3])points,
                                       .normals = (const float(*)[3])normals,
                                       .uv = (const float(*)[2])uv,
                                       .corners = mesh->face,
                                       .point_count = mesh->corners,
                                       .triangle_count = mesh->faces };
    return wr_triangles_new(&source, err);
}

WrScene *wr_hard_above(WrTriangles *triangles, double height)
{
    WrScene *scene = wr_scene_new();
    scene->shape = wr_hard_shape(WR_SURFACE_mesh);
    wr_scene_set_triangles(scene, triangles, "case", NULL);
    /* keeps the origin in place */
    memset(scene->shape.value + WR_MESH_CENTRE, 0, 3 * sizeof(double));
    scene->posed = true;
    scene->height = height;
    scene->lights_given = true;
    scene->lights[0] = (WrLight){
        .kind = WR_LIGHT_DIRECTIONAL, .where = { 0.3, 0.2, 1 }, .colour = { 1, 1, 1 }, .strength = 1
    };
    scene->camera = (WrCamera){
        .orthographic = true, .eye = { 0, 0, 5 }, .up = { 0, 1, 0 }, .fov_deg = 30, .size = 2.2
    };
    return scene;
}

bool wr_hard_mesh_tame(WrHardGauge *g, const WrHardMesh *mesh, WrError *err)
{
    WrTriangles *triangles = wr_hard_triangles(mesh, err);
    if (!triangles) return false;
    WrScene *scene = wr_hard_above(triangles, 0.1);
    WrField *field = wr_hard_waves(24, 20);
    const bool good = wr_hard_tame(g, field, scene, err);
    wr_field_free(field);
    wr_scene_free(scene);
    return good;
}

bool wr_hard_mikk(const WrHardMesh *mesh, WrTangent *out, WrError *err)
{
    WrTriangle faces[WR_HARD_FACES];
    memcpy(faces, mesh->face, (size_t)mesh->faces * sizeof *faces);
    return wr_tangents_mikk(mesh->corner, faces, mesh->faces, out, err);
}

void wr_hard_units(WrHardGauge *g, const WrHardMesh *mesh, const WrTangent *frames)
{
    for (int32_t i = 0; i < 3 * mesh->faces; i++) {
        const float *n = mesh->corner[mesh->face[i / 3][i % 3]].n;
        const WrVec3 up = { (double)n[0], (double)n[1], (double)n[2] };
        const WrTangent *at = &frames[i];
        const bool lost = at->sign == -1 && at->t.x == 1;
        wr_hard_holds(g, WR_HARD_DOUBLE, fabs(v3_len(at->t) - 1) < 1e-9);
        wr_hard_holds(g, WR_HARD_DOUBLE, lost || fabs(v3_dot(at->t, up)) < 1e-6);
        const WrVec3 b = v3_scale(v3_cross(up, at->t), at->sign);
        wr_hard_holds(g, WR_HARD_DOUBLE, v3_len(v3_sub(b, at->b)) < 1e-6);
    }
}

/* ---- meshes ---- */

/* Width and height of a triangle of the pairs: not 1, with which a missing division would be invisible. */
#define ACROSS 0.875
#define UP 0.75

/* Two triangles on both sides of x = 0, with those texture coordinates. */
static WrHardMesh pair(const float uv[4][2])
{
    WrHardMesh mesh = { { { { -ACROSS, 0, 0 }, { 0, 0, 1 }, 0, 0 },
                          { { 0, 0, 0 }, { 0, 0, 1 }, 0, 0 },
                          { { 0, UP, 0 }, { 0, 0, 1 }, 0, 0 },
                          { { ACROSS, 0, 0 }, { 0, 0, 1 }, 0, 0 } },
                        { { 0, 1, 2 }, { 1, 3, 2 } },
                        4,
                        2 };
    for (int i = 0; i < 4; i++) mesh.corner[i].u = uv[i][0], mesh.corner[i].v = uv[i][1];
    return mesh;
}

static void told(WrHardGauge *g, const WrHardMesh *mesh, int32_t collinear, int32_t mirrored)
{
    WrTriangles *made = wr_hard_triangles(mesh, NULL);
    const bool good = made && made->told.collinear == collinear && made->told.mirrored == mirrored;
    wr_hard_holds(g, WR_HARD_DOUBLE, good);
    wr_triangles_free(made);
}

/* Solves the tangent of the left or the right triangle directly. */
static bool solve(const WrHardMesh *mesh, int face, WrVec3 *t, double *det)
{
    WrVec3 p[3], b;
    double uv[3][2];
    for (int k = 0; k < 3; k++) {
        const WrTriangleCorner *c = &mesh->corner[mesh->face[face][k]];
        p[k] = (WrVec3){ (double)c->p[0], (double)c->p[1], (double)c->p[2] };
        uv[k][0] = (double)c->u, uv[k][1] = (double)c->v;
    }
    return wr_tangent_lecture(p, (const double(*)[2])uv, t, &b, det);
}

/* ---- slopes ---- */

/* u and v over the plane z = 0, one map for x < 0 and one for the rest. */
typedef struct Map {
    double u[3], v[3]; /* coefficients of 1, x / ACROSS and y / UP */
} Map;

enum { SIDE = 44 }; /* pixels of a picture 2.2 units high and wide */

static double at_pixel(int i)
{
    return (i + 0.5) * (2.2 / SIDE) - 1.1;
}

static double of_map(const double map[3], double x, double y)
{
    return map[0] + map[1] * x / ACROSS + map[2] * y / UP;
}

/* unit(n - Fu grad u - Fv grad v) for n = (0, 0, 1). */
static WrVec3 by_map(const WrField *field, const WrScene *scene, const Map *map, double x, double y)
{
    const double u = of_map(map->u, x, y), v = of_map(map->v, x, y);
    WrHardSlope s = wr_hard_sample(field, scene->scheme, u - floor(u), v - floor(v));
    s.fu *= scene->height, s.fv *= scene->height;
    const WrVec3 n = { -(s.fu * map->u[1] + s.fv * map->v[1]) / ACROSS,
                       -(s.fu * map->u[2] + s.fv * map->v[2]) / UP, 1 };
    return v3_unit(n, (WrVec3){ 0, 0, 1 });
}

/* Pictures of a flat mesh in the plane z = 0 within -1..1, under a table of waves `height` high, compared with n
   - grad F computed from the maps of u and v: float by the pictures' normals, double by the reference's. *bent:
   the largest slope found. */
static bool measure_bend(WrHardGauge *g, const WrHardMesh *mesh, const Map map[2], double height,
                         double *bent, WrError *err)
{
    WrTriangles *triangles = wr_hard_triangles(mesh, err);
    if (!triangles) return false;
    WrScene *scene = wr_hard_above(triangles, height);
    WrField *field = wr_hard_waves(48, 40);
    scene->scheme = WR_SCHEME_BSPLINE;
    scene->replicate_u = scene->replicate_v = 1;
    float *normals = wr_alloc((size_t)SIDE * SIDE, 3 * sizeof *normals);
    const WrFrameRequest request = {
        .field = field, .scene = scene, .width = SIDE, .height = SIDE, .normals = normals
    };
    bool good = true;
    *bent = 0;
    for (int way = 0; way < WR_HARD_WAYS && good; way++) {
        WrHardShot shot = { .renderer = NULL };
        good = wr_hard_shoot_by(g, &request, (WrHardWay)way, &shot, err);
        for (int i = 0; i < SIDE * SIDE && good; i++) {
            const double x = at_pixel(i % SIDE), y = -at_pixel(i / SIDE);
            if (shot.frame.rgba[4 * i + 3] != 1 || fabs(x) < 0.02) continue;
            const WrVec3 want = by_map(field, scene, &map[x >= 0], x, y);
            const float *n = normals + 3 * (size_t)i;
            wr_hard_off(g, WR_HARD_FLOAT,
                        v3_angle_rad((WrVec3){ (double)n[0], (double)n[1], (double)n[2] }, want));
            *bent = fmax(*bent, hypot(want.x, want.y) / want.z);
        }
        wr_hard_put_away(&shot);
    }
    for (int k = 0; k < 60 && good; k++) {
        const double x = wr_hard_between(g, 0, SIDE), y = wr_hard_between(g, 0, SIDE);
        WrProbe probe;
        good = wr_reference_probe(field, scene, SIDE, SIDE, 0, x, y, &probe, err);
        if (!good || !probe.hit) continue;
        const WrVec3 want =
            by_map(field, scene, &map[probe.at.p.x >= 0], probe.at.p.x, probe.at.p.y);
        wr_hard_off(g, WR_HARD_DOUBLE, v3_angle_rad(probe.perturbed, want));
    }
    wr_free(normals);
    wr_field_free(field);
    wr_scene_free(scene);
    return good;
}

/* Checks that the pair bends as the maps require, within those bounds, and at least by `least` at its steepest. */
static bool bends_within(WrHardGauge *g, const WrHardMesh *mesh, const Map map[2], double height,
                         double least, double in_float, double in_double, WrError *err)
{
    WrHardGauge apart = *g;
    double bent;
    for (int p = 0; p < WR_HARD_PRECISIONS; p++)
        apart.worst[p] = 0, apart.nudge[p] = 0, apart.checks[p] = 0;
    const bool good = measure_bend(&apart, mesh, map, height, &bent, err);
    wr_hard_holds(g, WR_HARD_FLOAT, apart.worst[WR_HARD_FLOAT] <= in_float);
    wr_hard_holds(g, WR_HARD_DOUBLE, apart.worst[WR_HARD_DOUBLE] <= in_double);
    wr_hard_holds(g, WR_HARD_DOUBLE, good && apart.checks[WR_HARD_FLOAT] > 500 && bent >= least);
    g->random = apart.random;
    return good;
}

/* ---- zero area ---- */

bool wr_hard_hc28(WrHardGauge *g, WrError *err)
{
    static const float one[4][2] = {
        { 0.3f, 0.7f }, { 0.3f, 0.7f }, { 0.3f, 0.7f }, { 0.3f, 0.7f }
    };
    static const Map flat[2] = { { { 0.3, 0, 0 }, { 0.7, 0, 0 } },
                                 { { 0.3, 0, 0 }, { 0.7, 0, 0 } } };
    static const float line[4][2] = { { 1, 0.5f }, { 0, 0 }, { 0, 0 }, { 1, 0.5f } };
    const WrHardMesh still = pair(one), thin = pair(line);
    WrTangent frames[3 * WR_HARD_FACES];
    WrVec3 t;
    double det;
    wr_hard_holds(g, WR_HARD_DOUBLE, !solve(&still, 0, &t, &det) && !solve(&thin, 1, &t, &det));
    told(g, &still, 2, 0);
    told(g, &thin, 2, 0);
    if (!wr_hard_mikk(&still, frames, err)) return false;
    wr_hard_units(g, &still, frames);
    if (!wr_hard_mikk(&thin, frames, err)) return false;
    wr_hard_units(g, &thin, frames);
    return bends_within(g, &still, flat, 0.1, 0, 1e-6, 1e-12, err) &&
           wr_hard_mesh_tame(g, &thin, err);
}

/* Along u = |x| the table still bends normals; across it nothing changes. */
bool wr_hard_hc127(WrHardGauge *g, WrError *err)
{
    static const float line[4][2] = { { 1, 0 }, { 0, 0 }, { 0, 0 }, { 1, 0 } };
    static const Map map[2] = { { { 0, -1, 0 }, { 0 } }, { { 0, 1, 0 }, { 0 } } };
    const WrHardMesh thin = pair(line);
    return bends_within(g, &thin, map, 0.1, 0.3, 1e-5, 1e-12, err);
}

/* With the triangle and without it: the picture has the same bits. */
bool wr_hard_hc29(WrHardGauge *g, WrError *err)
{
    static const float uv[4][2] = { { 1, 0 }, { 0, 0 }, { 0, 1 }, { 1, 0 } };
    const WrHardMesh whole = pair(uv);
    static const float at[3][3] = { { 0.25f, 0.25f, 0 }, { 0.25f, 0.25f, 0 }, { 0.5f, 0.25f, 0 } };
    static const float along[3][3] = { { 0, 0, 0 }, { 0.5f, 0, 0 }, { 0.75f, 0, 0 } };
    WrField *field = wr_hard_waves(24, 20);
    bool good = true;
    for (int k = 0; k < 3 && good; k++) {
        WrHardMesh more = whole;
        for (int i = 0; i < 3; i++) {
            WrTriangleCorner *c = &more.corner[4 + i];
            *c = (WrTriangleCorner){ .n = { 0, 0, 1 }, .u = 0.1f * (float)i, .v = 0.3f };
            memcpy(c->p, k == 0 ? at[0] : k == 1 ? at[i] : along[i], sizeof c->p);
            more.face[2][i] = 4 + i;
        }
        more.corners = 7, more.faces = 3;
        WrTriangles *with = wr_hard_triangles(&more, err),
                    *without = wr_hard_triangles(&whole, err);
        good = with && without;
        wr_hard_holds(g, WR_HARD_DOUBLE,
                      good && with->told.no_area == 1 && with->triangle_count == 2);
        WrScene *a = good ? wr_hard_above(with, 0.1) : NULL;
        WrScene *b = good ? wr_hard_above(without, 0.1) : NULL;
        for (int way = 0; way < WR_HARD_WAYS && good; way++) {
            WrFrameRequest request = { .field = field, .scene = a, .width = 40, .height = 40 };
            WrHardShot first = { .renderer = NULL }, second = { .renderer = NULL };
            good = wr_hard_shoot_by(g, &request, (WrHardWay)way, &first, err);
            request.scene = b;
            good = good && wr_hard_shoot_by(g, &request, (WrHardWay)way, &second, err);
            if (good) wr_hard_holds(g, WR_HARD_FLOAT, wr_hard_differ(&first, &second, 0) == 0);
            wr_hard_put_away(&first);
            wr_hard_put_away(&second);
        }
        wr_scene_free(a);
        wr_scene_free(b);
    }
    wr_field_free(field);
    return good;
}

/* ---- almost zero area ---- */

/* u = k x, v = k y with 1e-15: det is 1e-30 of either sign, and a proportionally higher table gives the same
   bend. */
bool wr_hard_hc30(WrHardGauge *g, WrError *err)
{
    const double k = (double)1e-15f;
    bool good = true;
    for (int side = -1; side <= 1 && good; side += 2) {
        const float s = 1e-15f * (float)side;
        const float uv[4][2] = { { -s, 0 }, { 0, 0 }, { 0, 1e-15f }, { s, 0 } };
        const Map map[2] = { { { 0, k * side, 0 }, { 0, 0, k } },
                             { { 0, k * side, 0 }, { 0, 0, k } } };
        const WrHardMesh mesh = pair(uv);
        WrTangent frames[3 * WR_HARD_FACES];
        WrVec3 t;
        double det;
        const bool solved = solve(&mesh, 0, &t, &det);
        wr_hard_holds(g, WR_HARD_DOUBLE, solved && (det > 0 ? 1 : -1) == side);
        wr_hard_holds(g, WR_HARD_DOUBLE,
                      solved && fabs(v3_unit(t, t).x - side) < 1e-12 && isfinite(v3_len(t)));
        good = wr_hard_mikk(&mesh, frames, err);
        if (!good) break;
        wr_hard_units(g, &mesh, frames);
        for (int i = 0; i < 6; i++)
            wr_hard_holds(g, WR_HARD_DOUBLE, frames[i].sign == side && frames[i].t.x * side > 0);
        told(g, &mesh, 0, side < 0 ? 2 : 0);
        good = bends_within(g, &mesh, map, 0.02 / k, 0.05, 1e-5, 1e-10, err);
    }
    return good;
}

/* As hc30, but so nearly along a line that det is rounding error: no frame, which is reported; u and v bend as
   required. */
bool wr_hard_hc126(WrHardGauge *g, WrError *err)
{
    static const float slip[] = { 0, -0.0f, 0x1p-24f, -0x1p-24f };
    bool good = true;
    for (int k = 0; k < 4 && good; k++) {
        const float uv[4][2] = { { 1, 1 }, { 0, 0 }, { 0.5f, 0.5f + slip[k] }, { 1, 1 } };
        const double rise = 0.5 + (double)uv[2][1] - 0.5;
        const Map map[2] = { { { 0, -1, 0.5 }, { 0, -1, rise } },
                             { { 0, 1, 0.5 }, { 0, 1, rise } } };
        const WrHardMesh mesh = pair(uv);
        WrTangent frames[3 * WR_HARD_FACES];
        WrVec3 t;
        double det;
        wr_hard_holds(g, WR_HARD_DOUBLE, !solve(&mesh, 0, &t, &det) && !solve(&mesh, 1, &t, &det));
        told(g, &mesh, 2, 0);
        good = wr_hard_mikk(&mesh, frames, err);
        if (good) wr_hard_units(g, &mesh, frames);
        good = good && bends_within(g, &mesh, map, 0.02, 0.05, 1e-5, 1e-6, err);
    }
    return good;
}

/* ---- mirrored ---- */

/* u = |x|, v = y: each corner that both share has two frames, of either handedness. */
bool wr_hard_hc31(WrHardGauge *g, WrError *err)
{
    static const float uv[4][2] = { { 1, 0 }, { 0, 0 }, { 0, 1 }, { 1, 0 } };
    const WrHardMesh mesh = pair(uv);
    WrTangent mikk[3 * WR_HARD_FACES], mean[3 * WR_HARD_FACES];
    WrTriangle faces[2];
    memcpy(faces, mesh.face, sizeof faces);
    if (!wr_hard_mikk(&mesh, mikk, err)) return false;
    if (!wr_tangents_average(mesh.corner, faces, 2, mean, err)) return false;
    wr_hard_units(g, &mesh, mikk);
    for (int i = 0; i < 6; i++) {
        const double side = i < 3 ? -1 : 1;
        wr_hard_holds(g, WR_HARD_DOUBLE, mikk[i].sign == side && fabs(mikk[i].t.x - side) < 1e-12);
        wr_hard_holds(g, WR_HARD_DOUBLE,
                      mean[i].sign == side && fabs(mean[i].t.x - ACROSS * side) < 1e-12);
    }
    told(g, &mesh, 0, 1);
    return wr_hard_mesh_tame(g, &mesh, err);
}

/* Bumps are raised on both sides: n' by the map, whose gradient does not depend on handedness. */
bool wr_hard_hc128(WrHardGauge *g, WrError *err)
{
    static const float uv[4][2] = { { 1, 0 }, { 0, 0 }, { 0, 1 }, { 1, 0 } };
    static const Map map[2] = { { { 0, -1, 0 }, { 0, 0, 1 } }, { { 0, 1, 0 }, { 0, 0, 1 } } };
    const WrHardMesh mesh = pair(uv);
    return bends_within(g, &mesh, map, 0.1, 0.3, 1e-5, 1e-12, err);
}
