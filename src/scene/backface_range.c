#include "scene/backface_range.h"

#include "base/vec.h"
#include "scene/objects.h"
#include "surface/triangles.h"

#include <math.h>

#define EDGE 64      /* points along a border */
#define STEP 15      /* degrees of the turntable */
#define CLEARLY 0.15 /* relative to the square of the object's radius */
#define HOLES 2      /* maximum for a surface */
#define SAME 1e-6    /* relative to the radius: the points are equal */

/* Vector areas of holes, object space: a hole seen from its opposite side shows the back.
   A closed surface has the vector area 0, so half the sum of p x dp around the border is the area of the
   missing part. Seen along `look` with area . look > 0 the view passes through the hole and meets the inside. */
typedef struct Holes {
    WrVec3 area[HOLES];
    int count;
} Holes;

typedef struct Edge {
    WrVec3 p[EDGE + 1];
} Edge;

/* side: 0 v = 0, 1 u = 1, 2 v = 1, 3 u = 0; each oriented counter-clockwise about N.
   Counter-clockwise: the border then turns about the same side as N, and joined edges of a face run in
   opposite directions. */
static Edge edge_of(const WrShape *shape, int face, int side)
{
    Edge edge;
    for (int i = 0; i <= EDGE; i++) {
        const double t = (side < 2 ? i : EDGE - i) / (double)EDGE;
        const double u = side == 1 ? 1 : side == 3 ? 0 : t, v = side == 2 ? 1 : side == 0 ? 0 : t;
        WrSurfacePoint at;
        wr_surface_at(shape, face, u, v, &at);
        edge.p[i] = at.p;
    }
    return edge;
}

/* True if one edge is the reverse of the other: then they are joined. */
static bool joined(const Edge *a, const Edge *b, double near)
{
    for (int i = 0; i <= EDGE; i++)
        if (v3_len(v3_sub(a->p[i], b->p[EDGE - i])) > near) return false;
    return true;
}

static WrVec3 swept(const Edge *edge, WrVec3 from)
{
    WrVec3 sum = { 0 };
    for (int i = 0; i < EDGE; i++)
        sum = v3_add(sum, v3_cross(v3_sub(edge->p[i], from), v3_sub(edge->p[i + 1], from)));
    return v3_scale(sum, 0.5);
}

/* The holes of one face, from its four sides: two if it is closed in one direction, one around all of
 * it if open.
 * At a pole an edge is a point and its area 0. A tube has two holes that must not cancel, so each is measured
 * apart. */
static void face_holes(const WrShape *shape, int face, double near, Holes *out)
{
    Edge edge[4];
    for (int side = 0; side < 4; side++) edge[side] = edge_of(shape, face, side);
    const bool round_v = joined(&edge[0], &edge[2], near),
               round_u = joined(&edge[1], &edge[3], near);
    const WrVec3 from = edge[0].p[0];
    WrVec3 area[4];
    for (int side = 0; side < 4; side++) area[side] = swept(&edge[side], from);
    if (round_u && round_v) return;
    if (round_u || round_v) {
        out->area[0] = swept(&edge[round_u ? 0 : 1], edge[round_u ? 0 : 1].p[0]);
        out->area[1] = swept(&edge[round_u ? 2 : 3], edge[round_u ? 2 : 3].p[0]);
        out->count = 2;
        return;
    }
    out->area[0] = v3_add(out->area[0], v3_add(v3_add(area[0], area[1]), v3_add(area[2], area[3])));
    out->count = 1;
}

static Holes holes_of_mesh(const WrTriangles *mesh)
{
    Holes holes = { 0 };
    if (mesh->closed) return holes;
    holes.count = 1;
    for (int32_t i = 0; i < mesh->triangle_count; i++) {
        WrVec3 p[3];
        for (int k = 0; k < 3; k++) {
            const float *q = mesh->corners[mesh->triangles[i].corner[k]].p;
            p[k] = (WrVec3){ q[0], q[1], q[2] };
        }
        const WrVec3 twice = v3_cross(v3_sub(p[1], p[0]), v3_sub(p[2], p[0]));
        holes.area[0] = v3_mad(holes.area[0], twice, 0.5);
    }
    return holes;
}

static Holes holes_of(const WrScene *object, double radius)
{
    const WrSurfaceInfo *info = wr_surfaces[object->shape.kind];
    Holes holes = { 0 };
    if (info->held && object->triangles) return holes_of_mesh(object->triangles);
    if (info->faces > 1 && !info->open) return holes;
    for (int face = 0; face < info->faces; face++)
        face_holes(&object->shape, face, SAME * radius, &holes);
    return holes;
}

/* The area of the holes that faces the viewer.
   Directions transform to object space by the cofactors, as normals do. */
static double seen(const Holes *holes, const WrPlacement *place)
{
    const WrVec3 look = v3_times(wr_place_turn_back(place, place->forward), place->cofactor);
    double sum = 0;
    for (int i = 0; i < holes->count; i++) sum += fmax(0, v3_dot(holes->area[i], look));
    return sum;
}

/* CLEARLY is the least increase over the view at turn 0: small glimpses at the rim do not count. */
static bool object_shows(const WrScene *part)
{
    WrPlacement place;
    const double radius = wr_shape_radius(&part->shape);
    const Holes holes = holes_of(part, radius);
    if (holes.count == 0 || !wr_scene_place_with_radius(part, radius, 0, 1, &place, NULL))
        return false;
    const double most = seen(&holes, &place) + CLEARLY * radius * radius;
    for (int turn = STEP; turn < 360; turn += STEP)
        if (wr_scene_place_with_radius(part, radius, turn, 1, &place, NULL) &&
            seen(&holes, &place) > most)
            return true;
    return false;
}

bool wr_scene_turn_shows_backs(const WrScene *scene)
{
    for (int i = 0; i < wr_scene_object_count(scene); i++) {
        const WrScene *object = wr_scene_object(scene, i);
        if (object->hidden || object->still) continue;
        WrScene *part = wr_scene_object_alone(scene, i, 1);
        const bool shows = object_shows(part);
        wr_scene_free(part);
        if (shows) return true;
    }
    return false;
}
