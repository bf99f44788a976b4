/* Hard cases of meshes: shared corners, folds, tangles, needles, fans. */
#include "hardcases/hardcases_frames.h"

#include "base/error.h"
#include "base/memory.h"
#include "field/field.h"
#include "render/reference/reference_mesh.h"
#include "scene/scene.h"

#include <string.h>

/* A corner whose (u,v) are x and y. */
static void take(double x, double y, double z, double nx, double ny, double nz,
                 WrTriangleCorner *to)
{
    *to = (WrTriangleCorner){
        { (float)x, (float)y, (float)z }, { (float)nx, (float)ny, (float)nz }, (float)x, (float)y
    };
}

/* ---- tangent frames ---- */

/* The square's diagonal, whose (u,v) differ by one ulp on its two sides: two corners and two frames, as the mesh
   reports; with equal (u,v) they are one. */
bool wr_hard_hc129(WrHardGauge *g, WrError *err)
{
    for (int apart = 0; apart <= 2; apart++) {
        WrHardMesh mesh = { .face = { { 0, 1, 2 }, { 4, 2, 3 } }, .corners = 5, .faces = 2 };
        for (int i = 0; i < 5; i++)
            take(i % 4 == 1 || i == 2, i == 2 || i == 3, 0, 0, 0, 1, &mesh.corner[i]);
        mesh.corner[3].v = 0.5f;
        for (int k = 0; k < 5; k++) mesh.corner[k].u += 1, mesh.corner[k].v += 1;
        for (int k = 0; k < apart; k++) mesh.corner[4].u = nextafterf(mesh.corner[4].u, 9);
        WrTangent frames[3 * WR_HARD_FACES];
        if (!wr_hard_mikk(&mesh, frames, err)) return false;
        wr_hard_units(g, &mesh, frames);
        const double turned = v3_angle_rad(frames[0].t, frames[3].t);
        wr_hard_holds(g, WR_HARD_DOUBLE, apart ? turned > 0.5 : turned == 0);
        WrTriangles *made = wr_hard_triangles(&mesh, err);
        if (!made) return false;
        wr_hard_holds(g, WR_HARD_DOUBLE, made->told.near_uv == (apart > 0));
        wr_hard_holds(g, WR_HARD_DOUBLE, made->corner_count == 4 + (apart > 0));
        wr_triangles_free(made);
        if (!wr_hard_mesh_tame(g, &mesh, err)) return false;
    }
    return true;
}

/* Two triangles folded onto each other, with opposite tangents and equal handedness: their sum is 0. */
bool wr_hard_hc130(WrHardGauge *g, WrError *err)
{
    WrHardMesh fold = { .face = { { 0, 1, 2 }, { 1, 0, 3 } }, .corners = 4, .faces = 2 };
    static const double x[4] = { 0, 0, -1, -1 }, y[4] = { 0, 1, 0, 0 };
    for (int i = 0; i < 4; i++) take(x[i], y[i], 0, 0, 0, 1, &fold.corner[i]);
    fold.corner[3].u = 1;
    WrTangent frames[3 * WR_HARD_FACES];
    if (!wr_hard_mikk(&fold, frames, err)) return false;
    wr_hard_units(g, &fold, frames);
    wr_hard_holds(g, WR_HARD_DOUBLE, frames[2].t.x == 1 && frames[2].sign == 1);
    wr_hard_holds(g, WR_HARD_DOUBLE, frames[5].t.x == -1 && frames[5].sign == 1);
    return wr_hard_mesh_tame(g, &fold, err);
}

/* A triangle with two coincident corners copies the frame of its neighbour's corners; a single degenerate one
   has (1,0,0). */
bool wr_hard_hc131(WrHardGauge *g, WrError *err)
{
    WrHardMesh mesh = { .face = { { 0, 1, 2 }, { 0, 0, 1 }, { 3, 3, 3 } },
                        .corners = 4,
                        .faces = 3 };
    static const double x[4] = { 0, 1, 0, 0.5 }, y[4] = { 0, 0, 1, 0.9 };
    for (int i = 0; i < 4; i++) {
        take(x[i], y[i], 0, 0, 0, 1, &mesh.corner[i]);
        mesh.corner[i].u = (float)-y[i], mesh.corner[i].v = (float)x[i];
    }
    WrTangent frames[3 * WR_HARD_FACES];
    if (!wr_hard_mikk(&mesh, frames, err)) return false;
    wr_hard_units(g, &mesh, frames);
    for (int k = 0; k < 3; k++) {
        const WrTangent *from = &frames[k / 2]; /* corners 0, 0 and 1 of the first triangle */
        wr_hard_holds(g, WR_HARD_DOUBLE, memcmp(&frames[3 + k], from, sizeof *from) == 0);
        wr_hard_holds(g, WR_HARD_DOUBLE, frames[6 + k].t.x == 1);
    }
    return wr_hard_mesh_tame(g, &mesh, err);
}

/* Three and more triangles at one edge, with corners chosen at random from few: grouping terminates, and frames
   are valid. */
bool wr_hard_hc132(WrHardGauge *g, WrError *err)
{
    for (int round = 0; round < 400; round++) {
        WrHardMesh mesh = { .corners = WR_HARD_CORNERS, .faces = WR_HARD_FACES };
        WrTriangle faces[WR_HARD_FACES];
        for (int i = 0; i < WR_HARD_CORNERS; i++) {
            WrTriangleCorner *c = &mesh.corner[i];
            const WrVec3 n =
                v3_unit((WrVec3){ wr_hard_between(g, -1, 1), wr_hard_between(g, -1, 1), 0.3 },
                        (WrVec3){ 0, 0, 1 });
            take(floor(wr_hard_between(g, -1, 2)), floor(wr_hard_between(g, -1, 2)),
                 floor(wr_hard_between(g, 0, 2)), n.x, n.y, n.z, c);
            c->u = (float)floor(wr_hard_between(g, 0, 3)) / 2;
            c->v = (float)floor(wr_hard_between(g, 0, 3)) / 2;
        }
        for (int i = 0; i < WR_HARD_FACES; i++)
            for (int k = 0; k < 3; k++)
                mesh.face[i][k] = k < 2 && i < 5 ? (k + i) % 2 /* five at one edge */
                                                 : (int32_t)wr_hard_between(g, 0, WR_HARD_CORNERS);
        memcpy(faces, mesh.face, sizeof faces);
        WrTangent frames[3 * WR_HARD_FACES], mean[3 * WR_HARD_FACES];
        if (!wr_hard_mikk(&mesh, frames, err) ||
            !wr_tangents_average(mesh.corner, faces, mesh.faces, mean, err))
            return false;
        wr_hard_units(g, &mesh, frames);
        for (int i = 0; i < 3 * WR_HARD_FACES; i++)
            wr_hard_holds(g, WR_HARD_DOUBLE, isfinite(v3_len(mean[i].t) + v3_len(mean[i].b)));
        WrTriangles *made = wr_hard_triangles(&mesh, NULL); /* all may have no area */
        wr_triangles_free(made);
        if (made && round < 6 && !wr_hard_mesh_tame(g, &mesh, err)) return false;
    }
    return true;
}

/* ---- normals ---- */

/* Normals of needles that are a ten-millionth as wide as long, compared with the cross product at their corner
   without rounding: in float the corners' own, in double the gradient's. */
bool wr_hard_hc133(WrHardGauge *g, WrError *err)
{
    for (int round = 0; round < 300; round++) {
        WrHardMesh mesh = { .face = { { 0, 1, 2 } }, .corners = 3, .faces = 1 };
        const WrVec3 along = v3_unit((WrVec3){ wr_hard_between(g, -1, 1), wr_hard_between(g, -1, 1),
                                               wr_hard_between(g, 0.1, 1) },
                                     (WrVec3){ 0, 0, 1 });
        /* the short edge's floats begin at 0, so that it has full precision */
        const WrVec3 wide = { wr_hard_between(g, 1e-8, 1e-7), wr_hard_between(g, -1e-7, -1e-8),
                              wr_hard_between(g, -1e-7, 1e-7) };
        take(0, 0, 0, 0, 0, 0, &mesh.corner[0]);
        take(along.x, along.y, along.z, 0, 0, 0, &mesh.corner[1 + round % 2]);
        take(wide.x, wide.y, wide.z, 0, 0, 0, &mesh.corner[2 - round % 2]);
        WrVec3 p[3];
        long double e[2][3], n[3];
        const double uv[3][2] = { { 0, 0 }, { 1, 0 }, { 0, 1 } };
        for (int k = 0; k < 3; k++)
            p[k] = (WrVec3){ (double)mesh.corner[k].p[0], (double)mesh.corner[k].p[1],
                             (double)mesh.corner[k].p[2] };
        for (int k = 0; k < 3; k++)
            for (int i = 0; i < 2; i++) /* exact, as are the products */
                e[i][k] = (long double)mesh.corner[i + 1].p[k] - (long double)mesh.corner[0].p[k];
        for (int k = 0; k < 3; k++) {
            const int a = (k + 1) % 3, b = (k + 2) % 3;
            n[k] = e[0][a] * e[1][b] - e[0][b] * e[1][a];
        }
        const WrVec3 want =
            v3_unit((WrVec3){ (double)n[0], (double)n[1], (double)n[2] }, (WrVec3){ 0, 0, 0 });
        WrVec3 normal, gu, gv;
        const bool good = wr_triangle_gradients(p, uv, &normal, &gu, &gv);
        wr_hard_off(g, WR_HARD_DOUBLE, good ? v3_angle_rad(normal, want) : INFINITY);
        WrTriangles *made = wr_hard_triangles(&mesh, err);
        if (!made) return false;
        const float *got = made->corners[0].n;
        wr_hard_off(g, WR_HARD_FLOAT,
                    v3_angle_rad((WrVec3){ (double)got[0], (double)got[1], (double)got[2] }, want));
        wr_triangles_free(made);
    }
    return true;
}

/* A zero or NaN normal is replaced by the mean of its faces', or by its face's if those are opposite. */
bool wr_hard_hc136(WrHardGauge *g, WrError *err)
{
    static const double bad[4] = { 0, (double)NAN, (double)INFINITY, -0.0 };
    for (int k = 0; k < 8; k++) {
        WrHardMesh mesh = { .face = { { 0, 1, 2 }, { 0, 2, 3 } }, .corners = 4, .faces = 2 };
        static const double x[4] = { -1, 1, 1, -1 }, y[4] = { -1, -1, 1, 1 };
        for (int i = 0; i < 4; i++) take(x[i], y[i], 0.25, 0, 0, 3, &mesh.corner[i]);
        mesh.corner[2].n[k % 3] = (float)bad[k % 4];
        if (bad[k % 4] == 0) memset(mesh.corner[2].n, 0, sizeof mesh.corner[2].n);
        const bool opposite = k >= 4;
        if (opposite) mesh.face[1][0] = 0, mesh.face[1][1] = 2, mesh.face[1][2] = 1;
        WrTriangles *made = wr_hard_triangles(&mesh, err);
        if (!made) return false;
        wr_hard_holds(g, WR_HARD_DOUBLE, made->told.bad_normal == 1);
        wr_hard_holds(g, WR_HARD_DOUBLE, made->told.face_normal == (opposite ? 2 : 0));
        for (int i = 0; i < made->corner_count; i++) {
            const float *n = made->corners[i].n;
            wr_hard_holds(g, WR_HARD_DOUBLE, n[0] == 0 && n[1] == 0 && fabsf(n[2]) == 1);
        }
        wr_triangles_free(made);
        if (!wr_hard_mesh_tame(g, &mesh, err)) return false;
    }
    return true;
}

/* ---- shared vertices and edges ---- */

/* A fan of `count` triangles around (x, y, 0), from number `from`, every `step`-th. */
static WrTriangles *fan(int count, int from, int step, double x, double y, WrError *err)
{
    float(*points)[3] = wr_alloc((size_t)count + 1, sizeof *points);
    int32_t(*corners)[3] = wr_alloc((size_t)count, sizeof *corners);
    int32_t made = 0;
    points[0][0] = (float)x, points[0][1] = (float)y;
    for (int i = 0; i < count; i++) {
        const double turn = 2 * acos(-1.0) * i / count;
        points[i + 1][0] = (float)(2 * cos(turn));
        points[i + 1][1] = (float)(2 * sin(turn));
        if (i % step != from) continue;
        corners[made][1] = i + 1;
        corners[made++][2] = (i + 1) % count + 1;
    }
    const WrTrianglesSource source = { .points = (const float(*)[3])points,
                                       .corners = (const int32_t(*)[3])corners,
                                       .point_count = count + 1,
                                       .triangle_count = made };
    WrTriangles *out = wr_triangles_new(&source, err);
    wr_free(points);
    wr_free(corners);
    return out;
}

/* Rays exactly through the centre vertex of a fan: in double by the reference's tree, in float by pictures with
   a sample at it (pictures of an odd size have one). */
bool wr_hard_hc134(WrHardGauge *g, WrError *err)
{
    enum { RAYS = 1000000, FANS = 10 };
    WrField *field = wr_hard_waves(8, 8);
    bool good = true;
    for (int k = 0; k < FANS && good; k++) {
        const float x = (float)wr_hard_between(g, -0.5, 0.5),
                    y = (float)wr_hard_between(g, -0.5, 0.5);
        WrTriangles *triangles = fan(3 + 5 * k, 0, 1, (double)x, (double)y, err);
        WrReferenceMesh mesh = { 0 };
        if (!triangles || !wr_reference_mesh_init(&mesh, wr_triangles_share(triangles), err)) {
            wr_triangles_free(triangles);
            good = false;
            break;
        }
        int lost = 0;
        for (int i = 0; i < RAYS / FANS; i++) {
            const WrVec3 eye = { wr_hard_between(g, -3, 3), wr_hard_between(g, -3, 3),
                                 wr_hard_between(g, 1, 4) };
            const WrReferenceRay ray = { .q = eye,
                                         .d = v3_sub((WrVec3){ (double)x, (double)y, 0 }, eye) };
            WrReferenceHit hit = { .s = INFINITY };
            lost += !wr_reference_mesh_hit(&mesh, false, &ray, &hit);
        }
        wr_hard_off(g, WR_HARD_DOUBLE, lost);
        wr_reference_mesh_fini(&mesh);
        WrScene *scene = wr_hard_above(triangles, 0);
        const WrFrameRequest request = {
            .field = field, .scene = scene, .width = 33, .height = 33
        };
        scene->camera.eye = (WrVec3){ (double)x, (double)y, 5 };
        scene->camera.target = (WrVec3){ (double)x, (double)y, 0 };
        scene->camera.size = 0.5;
        for (int way = 0; way < WR_HARD_WAYS && good; way++) {
            WrHardShot shot = { .renderer = NULL };
            good = wr_hard_shoot_by(g, &request, (WrHardWay)way, &shot, err);
            for (int i = 0; i < 33 * 33 && good; i++)
                wr_hard_holds(g, WR_HARD_FLOAT, shot.frame.rgba[4 * i + 3] == 1);
            wr_hard_put_away(&shot);
        }
        wr_scene_free(scene);
    }
    wr_field_free(field);
    return good;
}

/* Two fans with alternating triangles: at every angle each sample belongs to exactly one of them. */
bool wr_hard_hc135(WrHardGauge *g, WrError *err)
{
    enum { TURNS = 1000, ACROSS = 24 };
    WrField *field = wr_hard_waves(8, 8);
    bool good = true;
    for (int k = 0; k < TURNS && good; k++) {
        const int count = 4 + 2 * (k % 9);
        unsigned char owners[ACROSS * ACROSS] = { 0 };
        for (int half = 0; half < 2 && good; half++) {
            WrTriangles *triangles = fan(count, half, 2, 0, 0, err);
            if (!triangles) {
                good = false;
                break;
            }
            WrScene *scene = wr_hard_above(triangles, 0);
            scene->rotate_deg = (WrVec3){ 0, 0, k % 8 == 0 ? 90.0 * (k / 8) : 2.628 * k };
            scene->camera.size = 1;
            const WrFrameRequest request = {
                .field = field, .scene = scene, .width = ACROSS, .height = ACROSS
            };
            WrHardShot shot = { .renderer = NULL };
            const WrHardWay way = k % 4 ? WR_HARD_EXACT : WR_HARD_WIDE;
            good = wr_hard_shoot_by(g, &request, way, &shot, err);
            for (int i = 0; i < ACROSS * ACROSS && good; i++)
                owners[i] += (unsigned char)(shot.frame.rgba[4 * i + 3] == 1);
            wr_hard_put_away(&shot);
            wr_scene_free(scene);
        }
        for (int i = 0; i < ACROSS * ACROSS && good; i++)
            wr_hard_holds(g, k % 4 ? WR_HARD_FLOAT : WR_HARD_DOUBLE, owners[i] == 1);
    }
    wr_field_free(field);
    return good;
}
