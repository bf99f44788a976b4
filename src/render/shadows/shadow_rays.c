/* Shadow casters: closed forms and facets, and the visibility of a lamp past them.
   A body is a caster in its own object space: closed form, quads or a tree of triangles. WrShadowRaysTo adds
   the affine map from the lighting space of the shaded object to it. Rays keep their parameter through the
   map, so t compares with the distance to the lamp. */
#include "render/shadows/shadow_rays.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "field/field.h"
#include "render/tessellation/dice.h"
#include "render/tessellation/mesh_relief.h"
#include "surface/ray_tree.h"
#include "surface/triangles.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* Builds the geometry. Call body_size before, with the same field. Errors: no memory.
   Invariant: a body is measured (size) for every frame, but built (update) only when some object may receive
   its shadow. */
static bool shadow_rays_body_update(WrShadowRaysBody *body, const WrScene *scene,
                                    const WrField *field, WrError *err);

/* Computes only the body's size. field: table of F for a displaced surface; NULL with a formula. moves: a
   displaced surface is intersected as displaced, else its base. */
static void shadow_rays_body_size(WrShadowRaysBody *body, const WrScene *scene,
                                  const WrField *field, bool moves);

/* True if the object can never hide a lamp from itself. Its size must be known. */
static bool shadow_rays_spares_itself(const WrShadowRaysBody *body);

/* ---- torus ---- */

/* Shadow test of a torus in closed form. Sign changes show whether a ray hits it, so no root of the quartic has
   to be found. */

/* c[0] + c[1] t + ... c[degree] t^degree */
static double value(const double *c, int degree, double t)
{
    double sum = c[degree];
    for (int k = degree - 1; k >= 0; k--) sum = sum * t + c[k];
    return sum;
}

/* of the interval: near an extreme, the value's error is the square of this */
#define NEAR_ENOUGH 1e-7

/* Root of the cubic c, which is monotonic from a to b. false: there is none.
   Regula falsi for the start, Newton's method inside a bracket, bisection when a step leaves it. */
static bool root_of(const double c[4], double a, double b, double *root)
{
    const double slopes[3] = { c[1], 2 * c[2], 3 * c[3] };
    const double from = value(c, 3, a), to = value(c, 3, b), near = NEAR_ENOUGH * (b - a);
    if (!(a < b) || (from > 0) == (to > 0)) return false;
    double t = a + (b - a) * (from / (from - to));
    for (int step = 0; step < 60; step++) {
        const double at = value(c, 3, t), slope = value(slopes, 2, t);
        if ((at > 0) == (from > 0)) a = t;
        else b = t;
        double next = slope != 0 ? t - at / slope : a;
        if (!(next > a && next < b)) next = a + (b - a) / 2;
        const bool done = fabs(next - t) <= near;
        t = next;
        if (done) break;
    }
    *root = t;
    return true;
}

/* True if p is on the outer half and the ray leads outwards. Then it never returns, because the squared distance
   from the circle in the tube's middle is convex outside that circle.
   With g = (rho - R)^2 + z^2 the squared distance from the circle, half its derivative along the ray is ((rho
   - R) (x dx + y dy) + rho z dz) / rho. This spares most rays that start on the torus itself. */
static bool goes_away(double R, double r, WrVec3 p, WrVec3 d)
{
    const double rho = sqrt(p.x * p.x + p.y * p.y), out = p.x * d.x + p.y * d.y;
    const double off = rho - R;
    return off >= 0 && out >= 0 && off * off + p.z * p.z > r * r &&
           off * out + rho * p.z * d.z >= 0;
}

/* With the foot f nearest the middle and p = f + t d, G = (p.p + R^2 - r^2)^2 - 4 R^2 (x^2 + y^2) is 0 on the
   torus; p.p = f.f + t^2 d.d, so it has no t^3. G changes sign on the way exactly if it does so between the ends
   of the way and its extremes, the roots of a cubic.
   Coefficients, with k = f.f + R^2 - r^2 and dd = d.d:
       G = (k + dd t^2)^2 - 4 R^2 ((f_x + t d_x)^2 + (f_y + t d_y)^2).
   G' is a cubic without t^2; its own extremes are at +-sqrt(-q / 6 dd^2), so it is monotonic on each of the
   three parts between `ends`. Rays that only touch the tube are undecided by rounding, which a shadow's edge
   hides. */
static bool shadow_rays_meets_torus(const WrShape *shape, WrVec3 o, WrVec3 d, double most)
{
    const double R = shape->value[0], r = shape->value[1], dd = v3_dot(d, d);
    const double start = v3_dot(o, d) / dd;
    const WrVec3 f = v3_mad(o, d, -start);
    const double left = (R + r) * (R + r) - v3_dot(f, f);
    if (!(left >= 0) || goes_away(R, r, o, d)) return false;
    const double half = sqrt(left / dd);
    const double low = fmax(start, -half), high = fmin(start + most, half);
    if (!(low < high)) return false;
    const double k = v3_dot(f, f) + (R - r) * (R + r), four = 4 * R * R;
    const double q = 2 * dd * k - four * (d.x * d.x + d.y * d.y);
    const double G[5] = { k * k - four * (f.x * f.x + f.y * f.y),
                          -2 * four * (f.x * d.x + f.y * d.y), q, 0, dd * dd };
    const double slope[4] = { G[1], 2 * q, 0, 4 * dd * dd };
    const double turn = q < 0 ? sqrt(-q / (6 * dd * dd)) : 0;
    const double ends[4] = { low, fmin(fmax(-turn, low), high), fmin(fmax(turn, low), high), high };
    const bool outside = value(G, 4, low) > 0;
    bool meets = (value(G, 4, high) > 0) != outside;
    for (int i = 0; i < 3 && !meets; i++) {
        double t;
        if (root_of(slope, ends[i], ends[i + 1], &t)) meets = (value(G, 4, t) > 0) != outside;
    }
    return meets;
}

/* ---- facets ---- */

/* Facets of a surface without closed-form intersection, or of a displaced one. Their error is a few
   hundred-thousandths of its radius. */

#define OFF 0x1p-15       /* of the radius: error that facets may have, if ... */
#define MESH_OFF 0x1p-12  /* the same of relief on a mesh, if ... */
#define RELIEF_MAX 500000 /* ... this many triangles are enough */
#define MAX_MOST 512      /* ... this many steps are enough */
#define LEAST 16
#define LOOKS 16   /* test points in each direction for the error of a step */
#define CORNERS 64 /* rows at which Pv may be discontinuous */

typedef struct Cut {
    const WrShape *shape;
    const WrRaised *raised; /* P + F n; NULL: P */
    int face;
    WrSurfaceCell cell;
    double corner[CORNERS];
    int corners;
    double rows[MAX_MOST + CORNERS + 1];
    int across, down; /* number of steps */
    double off;       /* largest error of the facets */
} Cut;

static WrVec3 at(const Cut *cut, double u, double v)
{
    WrSurfacePoint p;
    double f = 0;
    wr_surface_at(cut->shape, cut->face, u, v, &p);
    if (cut->raised) wr_scene_height(cut->raised->scene, cut->raised->field, u, v, &f, NULL, NULL);
    return v3_mad(p.p, p.n_unit, f);
}

static double between(double a, double b, double part)
{
    return a + part * (b - a);
}

static bool holds_corner(const Cut *cut, double v, double step)
{
    for (int k = 0; k < cut->corners; k++)
        if (cut->corner[k] > v && cut->corner[k] < v + step) return true;
    return false;
}

/* Largest distance of a step's middle from its chord, with n steps along u or v.
   A parabola's chord is farthest from it in the middle. 16 x 16 steps are tested, not all. Steps that contain
   a corner row are skipped, because place_rows inserts a row there. */
static double off_by(const Cut *cut, bool along_u, int n)
{
    const WrSurfaceCell c = cut->cell;
    const double step = (along_u ? c.u1 - c.u0 : c.v1 - c.v0) / n;
    double most = 0;
    for (int i = 0; i < LOOKS; i++)
        for (int k = 0; k < LOOKS; k++) {
            const double start = (along_u ? c.u0 : c.v0) + floor((i + 0.5) * n / LOOKS) * step;
            const double other = (k + 0.43) / LOOKS;
            if (!along_u && holds_corner(cut, start, step)) continue;
            const double u = along_u ? start : between(c.u0, c.u1, other);
            const double v = along_u ? between(c.v0, c.v1, other) : start;
            const double du = along_u ? step : 0, dv = along_u ? 0 : step;
            const WrVec3 chord = v3_scale(v3_add(at(cut, u, v), at(cut, u + du, v + dv)), 0.5);
            const double d = v3_len(v3_sub(at(cut, u + du / 2, v + dv / 2), chord));
            if (d > most) most = d;
        }
    return most;
}

/* Largest distance of a cell's centre from the diagonal along which the cell is cut.
   The diagonal's error includes twist, |Puv| du dv / 4, which the errors along u and v do not show. */
static double off_across(const Cut *cut, int across, int down)
{
    const WrSurfaceCell c = cut->cell;
    const double du = (c.u1 - c.u0) / across, dv = (c.v1 - c.v0) / down;
    double most = 0;
    for (int i = 0; i < LOOKS; i++)
        for (int k = 0; k < LOOKS; k++) {
            const double u = c.u0 + floor((i + 0.5) * across / LOOKS) * du;
            const double v = c.v0 + floor((k + 0.5) * down / LOOKS) * dv;
            if (holds_corner(cut, v, dv)) continue;
            const WrVec3 chord = v3_scale(v3_add(at(cut, u, v), at(cut, u + du, v + dv)), 0.5);
            const double d = v3_len(v3_sub(at(cut, u + du / 2, v + dv / 2), chord));
            if (d > most) most = d;
        }
    return most;
}

/* Starting number: the table's texels there, before the error is measured. */
static int least_steps(const Cut *cut, bool along_u)
{
    if (!cut->raised) return LEAST;
    const WrScene *scene = cut->raised->scene;
    const WrField *field = cut->raised->field;
    const bool table = scene->analytic.kind == WR_ANALYTIC_OFF;
    const double of = fabs(along_u ? scene->replicate_u : scene->replicate_v);
    const int texels = !table ? LEAST : along_u ? wr_field_width(field) : wr_field_height(field);
    return (int)fmin(fmax(LEAST, of * texels), MAX_MOST);
}

static int steps_of(const Cut *cut, bool along_u, double enough)
{
    int n = least_steps(cut, along_u);
    while (n < MAX_MOST && off_by(cut, along_u, n) > enough) n *= 2;
    return n < MAX_MOST ? n : MAX_MOST;
}

/* Chooses the steps in both directions; returns the number along v, cut->off holds their error. Twice the
   error of one direction is allowed across a cell. The sum of both directions' errors bounds the rest. */
static int choose_steps(Cut *cut, double enough)
{
    int across = steps_of(cut, true, enough), down = steps_of(cut, false, enough);
    while ((across < MAX_MOST || down < MAX_MOST) && off_across(cut, across, down) > 2 * enough) {
        across = 2 * across < MAX_MOST ? 2 * across : MAX_MOST;
        down = 2 * down < MAX_MOST ? 2 * down : MAX_MOST;
    }
    cut->across = across;
    cut->off =
        fmax(off_across(cut, across, down), off_by(cut, true, across) + off_by(cut, false, down));
    return down;
}

/* Merges the even rows with the corner rows, in ascending order; down is the number of strips. */
static void place_rows(Cut *cut, int steps)
{
    int next = 0;
    cut->down = 0;
    for (int j = 0; j <= steps; j++) {
        const double v = between(cut->cell.v0, cut->cell.v1, (double)j / steps);
        while (next < cut->corners && cut->corner[next] < v)
            cut->rows[cut->down++] = cut->corner[next++];
        cut->rows[cut->down++] = v;
    }
    cut->down--;
}

static void find_corners(Cut *cut)
{
    const WrSurfaceInfo *info = wr_surfaces[cut->shape->kind];
    cut->corners = info->corners ? info->corners(cut->shape, cut->corner, CORNERS) : 0;
    if (cut->corners > CORNERS) cut->corners = CORNERS;
}

typedef struct Facets {
    float (*points)[3];
    int32_t (*corners)[3];
    int32_t point_count, count;
} Facets;

/* Point (i, j) is at j * (across + 1) + i. Triangles share vertices within a face; faces touch without
   sharing. */
static void add_cut(const Cut *cut, Facets *to)
{
    const int32_t first = to->point_count, wide = cut->across + 1;
    for (int j = 0; j <= cut->down; j++)
        for (int i = 0; i <= cut->across; i++) {
            const double u = between(cut->cell.u0, cut->cell.u1, (double)i / cut->across);
            const WrVec3 p = at(cut, u, cut->rows[j]);
            float *out = to->points[to->point_count++];
            out[0] = (float)p.x, out[1] = (float)p.y, out[2] = (float)p.z;
        }
    for (int j = 0; j < cut->down; j++)
        for (int i = 0; i < cut->across; i++) {
            const int32_t a = first + j * wide + i, b = a + wide;
            const int32_t two[2][3] = { { a, a + 1, b + 1 }, { a, b + 1, b } };
            for (int k = 0; k < 6; k++) to->corners[to->count + k / 3][k % 3] = two[k / 3][k % 3];
            to->count += 2;
        }
}

static bool facets_of(WrShadowRaysBody *body, const WrRaised *raised, WrError *err)
{
    const int faces = wr_surfaces[body->shape.kind]->faces;
    Cut *cuts = wr_alloc((size_t)faces, sizeof *cuts);
    size_t points = 0, cells = 0;
    double off = 0;
    for (int face = 0; face < faces; face++) {
        Cut *cut = &cuts[face];
        cut->shape = &body->shape, cut->raised = raised, cut->face = face;
        cut->cell = wr_surface_cell(&body->shape, face);
        find_corners(cut);
        place_rows(cut, choose_steps(cut, OFF * body->radius));
        points += (size_t)(cut->across + 1) * (size_t)(cut->down + 1);
        cells += (size_t)cut->across * (size_t)cut->down;
        off = fmax(off, cut->off);
    }
    Facets facets = { .points = wr_try_alloc(points, sizeof *facets.points, "facets", err) };
    if (facets.points)
        facets.corners = wr_try_alloc(2 * cells, sizeof *facets.corners, "facets", err);
    for (int face = 0; face < faces && facets.corners; face++) add_cut(&cuts[face], &facets);
    const WrTrianglesSource source = { .points = (const float(*)[3])facets.points,
                                       .corners = (const int32_t(*)[3])facets.corners,
                                       .point_count = facets.point_count,
                                       .triangle_count = facets.count };
    body->triangles = facets.corners ? wr_triangles_new(&source, err) : NULL;
    /* Facets cut inside a convex surface by up to `off`. Rays start higher by twice that, so that the surface
       does not shade itself with its own facets. */
    body->lift += 2 * off;
    wr_free(facets.points);
    wr_free(facets.corners);
    wr_free(cuts);
    return body->triangles != NULL;
}

/* Builds facets of a surface that has no closed form, or is displaced, into body->triangles; adds their error to
   body->lift. */
static bool shadow_rays_facets(WrShadowRaysBody *body, const WrScene *scene, const WrField *field,
                               WrError *err)
{
    WrRaised raised = { 0 };
    if (!(body->rise > 0)) return facets_of(body, NULL, err);
    const bool good = wr_raised_init(&raised, scene, field, err) && facets_of(body, &raised, err);
    wr_raised_fini(&raised);
    return good;
}

/* As shadow_rays_facets, for the relief on a mesh. */
static bool shadow_rays_mesh_relief(WrShadowRaysBody *body, const WrScene *scene,
                                    const WrField *field, WrError *err)
{
    WrTriangles *mesh =
        scene->triangles ? wr_triangles_share(scene->triangles) : wr_triangles_square();
    WrMeshRelief relief = { 0 };
    WrRaised raised = { 0 };
    WrMeshReliefRequest ask = { .mesh = mesh,
                                .stretch = { 1, 1, 1 },
                                .scale = 1,
                                .error = MESH_OFF * body->radius,
                                .most = RELIEF_MAX };
    bool good = wr_raised_init(&raised, scene, field, err);
    ask.scene = raised.scene, ask.field = raised.field;
    good = good && wr_mesh_relief_make(&relief, &ask, err);
    while (good && relief.full) {
        ask.error *= 4;
        wr_mesh_relief_fini(&relief);
        good = wr_mesh_relief_make(&relief, &ask, err);
    }
    int32_t(*corners)[3] =
        good ? wr_try_alloc((size_t)relief.triangles.count, sizeof *corners, "facets", err) : NULL;
    for (int32_t i = 0; i < relief.triangles.count && corners; i++)
        memcpy(corners[i], relief.triangles.data[i].point, sizeof *corners);
    const WrTrianglesSource source = { .points = (const float(*)[3])relief.at.data,
                                       .corners = (const int32_t(*)[3])corners,
                                       .point_count = relief.points.count,
                                       .triangle_count = relief.triangles.count };
    body->triangles = corners ? wr_triangles_new(&source, err) : NULL;
    body->lift += 2 * ask.error;
    wr_free(corners);
    wr_mesh_relief_fini(&relief);
    wr_raised_fini(&raised);
    wr_triangles_free(mesh);
    return body->triangles != NULL;
}

/* ---- place ---- */

/* Selection of possible casters: which objects can hide lamps from which, by bounding spheres and lamp
   positions. */

#define SLACK (1 + 1e-9)

/* An object with its placement. */
typedef struct Standing {
    WrPlacement place;
    double ball; /* radius of the bounding sphere, world; INFINITY: unbounded */
} Standing;

static double widest(const WrPlacement *place)
{
    const WrVec3 s = place->stretch;
    return place->stretched ? fmax(fabs(s.x), fmax(fabs(s.y), fabs(s.z))) : 1;
}

static bool stand(const WrShadowRaysRequest *ask, int i, Standing *out, WrError *err)
{
    const WrScene *scene = ask->scenes[i];
    WrShadowRaysBody *body = ask->bodies[i];
    shadow_rays_body_size(body, scene, ask->fields[i], ask->moves);
    if (!wr_scene_place_with_radius(scene, body->radius, ask->turn_deg, ask->aspect, &out->place,
                                    err))
        return false;
    out->ball = wr_shape_endless(&scene->shape)
                    ? INFINITY
                    : (body->radius + body->rise) * out->place.size * widest(&out->place) * SLACK;
    return true;
}

/* Distance between a fixed sphere and a sphere that moves from the object to the lamp. It shrinks to a point at
   a point lamp, or keeps its size towards a distant one. Below 0: they touch. t: position along the way, 0..1. */
static double gap(WrVec3 from, WrVec3 way, double ball, bool shrinks, WrVec3 to, double t)
{
    return v3_len(v3_sub(v3_mad(from, way, t), to)) - (shrinks ? ball * (1 - t) : ball);
}

/* True if b can be between any point of a and the lamp. The gap is convex in t, so its minimum is found by
   ternary search.
   For a point lamp the union of all rays from a's sphere is a cone that ends at the lamp, for a distant one a
   cylinder; `wide` adds the area lamp's radius at the far end. b is a possible caster if its sphere touches
   that region. */
static bool may_hide(const Standing *a, const Standing *b, const WrLight *light)
{
    const double spread = wr_tan(fmin(light->size_deg, 45) * WR_PI / 180);
    const bool point = wr_light_kinds[light->kind].placed;
    const WrVec3 from = a->place.position, to = b->place.position, ahead = { 0, 0, 1 };
    if (!(a->ball < INFINITY) || !(b->ball < INFINITY)) return true;
    const double far = v3_len(v3_sub(to, from)) + a->ball + b->ball;
    const WrVec3 way =
        point ? v3_sub(light->where, from) : v3_scale(v3_unit(light->where, ahead), far);
    double low = 0, high = 1;
    for (int i = 0; i < 100; i++) {
        const double x = low + (high - low) / 3, y = high - (high - low) / 3;
        if (gap(from, way, a->ball, point, to, x) < gap(from, way, a->ball, point, to, y)) high = y;
        else low = x;
    }
    const double wide = spread * (point ? v3_len(way) + a->ball : far);
    return gap(from, way, a->ball, point, to, (low + high) / 2) <= (b->ball + wide) * SLACK;
}

static bool may_any(const WrShadowRaysRequest *ask, const Standing *a, const Standing *b)
{
    const WrScene *scene = ask->scenes[ask->at];
    for (int i = 0; i < scene->light_count; i++)
        if (scene->lights[i].shadow && may_hide(a, b, &scene->lights[i])) return true;
    return false;
}

/* Rotation from a's axes to b's, times `by`, with b's stretch removed.
   m = by S_b^-1 M_b^T M_a, with M the rotations and S_b the stretch. */
static void turn_to(const WrPlacement *a, const WrPlacement *b, double by, double m[9])
{
    const double stretch[3] = { b->stretched ? b->stretch.x : 1, b->stretched ? b->stretch.y : 1,
                                b->stretched ? b->stretch.z : 1 };
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            double sum = 0;
            for (int j = 0; j < 3; j++) sum += b->rotation[3 * j + i] * a->rotation[3 * j + k];
            m[3 * i + k] = by * sum / stretch[i];
        }
}

/* The shaded point in a's lighting space is p; in b's object space it is m p + from. from absorbs both
   centres, so that any_hides needs one matrix product per ray. */
static WrShadowRaysTo see(const Standing *a, const Standing *b, const WrShadowRaysBody *body,
                          bool own)
{
    WrShadowRaysTo to = { .body = body, .own = own, .radius = b->ball / a->place.size * SLACK };
    const WrPlacement *pa = &a->place, *pb = &b->place;
    const WrVec3 stretch = pa->stretched ? pa->stretch : (WrVec3){ 1, 1, 1 };
    const WrVec3 centre = v3_times(pa->centre, stretch);
    turn_to(pa, pb, pa->size / pb->size, to.m);
    const WrVec3 at = wr_world_to_object(pb, pa->position);
    const double *m = to.m;
    to.from = (WrVec3){ at.x - (m[0] * centre.x + m[1] * centre.y + m[2] * centre.z),
                        at.y - (m[3] * centre.x + m[4] * centre.y + m[5] * centre.z),
                        at.z - (m[6] * centre.x + m[7] * centre.y + m[8] * centre.z) };
    const WrVec3 off = wr_place_turn_back(pa, v3_sub(pb->position, pa->position));
    to.middle = v3_mad(centre, off, 1 / pa->size);
    return to;
}

static bool finite_to(const WrShadowRaysTo *to)
{
    double sum = to->from.x + to->from.y + to->from.z;
    for (int k = 0; k < 9; k++) sum += to->m[k];
    return isfinite(sum);
}

/* Equal areas: the k-th of n rings has radius sqrt((k + 1/2) / n); successive points turn by the golden angle,
   0.382 turns. */
static void fill_disc(WrShadowRays *cast, int rays)
{
    cast->rays = rays < WR_SHADOW_RAYS_RAYS ? rays : WR_SHADOW_RAYS_RAYS;
    for (int k = 0; k < cast->rays; k++) { /* evenly distributed, by the golden angle */
        const double r = sqrt((k + 0.5) / cast->rays);
        double sine, cosine;
        wr_sincos_turns(0.38196601125010515 * k, &sine, &cosine);
        cast->disc[k][0] = r * cosine, cast->disc[k][1] = r * sine;
    }
}

/* to[0 .. count) can hide lamps of this object, to[count .. all) are the others, kept on request for views
   that show all. */
bool wr_shadow_rays_prepare(WrShadowRays *cast, const WrShadowRaysRequest *ask, WrError *err)
{
    Standing own, other;
    const int count = ask->count < WR_OBJECTS_MAX ? ask->count : WR_OBJECTS_MAX;
    cast->count = cast->all = 0;
    fill_disc(cast, ask->rays);
    if (!stand(ask, ask->at, &own, err)) return false;
    /* first those that can, then the others */
    for (int round = 0; round < (ask->all ? 2 : 1); round++)
        for (int i = 0; i < count; i++) {
            if (!stand(ask, i, &other, err)) return false;
            const bool self = i == ask->at;
            const bool can =
                self ? !shadow_rays_spares_itself(ask->bodies[i]) : may_any(ask, &own, &other);
            const WrShadowRaysTo to = see(&own, &other, ask->bodies[i], self);
            if (can != (round == 0) || !finite_to(&to)) continue;
            if (!shadow_rays_body_update(ask->bodies[i], ask->scenes[i], ask->fields[i], err))
                return false;
            cast->to[cast->all++] = to;
            cast->count += can;
        }
    const WrShadowRaysBody *body = ask->bodies[ask->at];
    cast->lift = fmax(body->lift, 0x1p-19 * body->radius) * widest(&own.place);
    return true;
}

/* A lamp without light casts no shadow: nothing is built for it. */
bool wr_shadow_rays_needed(const WrScene *scene)
{
    for (int i = 0; i < scene->light_count; i++) {
        const WrLight *light = &scene->lights[i];
        const WrVec3 c = light->colour;
        if (light->shadow && light->strength != 0 && (c.x != 0 || c.y != 0 || c.z != 0))
            return true;
    }
    return false;
}

/* A convex body lies behind each of its tangent planes, and a ray towards a lamp in front of the plane never
   meets it again. */
static bool shadow_rays_spares_itself(const WrShadowRaysBody *body)
{
    const WrSurfaceInfo *info = wr_surfaces[body->shape.kind];
    if (body->rise > 0) return false;
    return info->convex_closed || (info->flat && !info->held);
}

/* ---- closed forms ---- */

static void take_quads(WrShadowRaysBody *body)
{
    const WrSurfaceInfo *info = wr_surfaces[body->shape.kind];
    body->endless = wr_shape_endless(&body->shape);
    body->quad_count = info->faces;
    for (int face = 0; face < info->faces; face++) {
        const WrSurfaceCell c = wr_surface_cell(&body->shape, face);
        WrSurfacePoint at;
        WrShadowRaysQuad *quad = &body->quads[face];
        wr_surface_at(&body->shape, face, c.u0, c.v0, &at);
        quad->from = at.p, quad->normal = at.n_unit;
        quad->along = v3_scale(at.pu, 1 / v3_dot(at.pu, at.pu) / (c.u1 - c.u0));
        quad->across = v3_scale(at.pv, 1 / v3_dot(at.pv, at.pv) / (c.v1 - c.v0));
    }
}

static bool meets_quads(const WrShadowRaysBody *body, WrVec3 o, WrVec3 d, double most)
{
    for (int k = 0; k < body->quad_count; k++) {
        const WrShadowRaysQuad *quad = &body->quads[k];
        const double fall = v3_dot(d, quad->normal);
        const double t = fall != 0 ? v3_dot(v3_sub(quad->from, o), quad->normal) / fall : 0;
        if (!(t > 0 && t < most)) continue;
        const WrVec3 w = v3_sub(v3_mad(o, d, t), quad->from);
        const double x = v3_dot(w, quad->along), y = v3_dot(w, quad->across);
        if (body->endless || (x >= 0 && x <= 1 && y >= 0 && y <= 1)) return true;
    }
    return false;
}

/* Real roots of a t^2 + 2 b t + c, without cancellation.
   The larger root in magnitude from the sum without cancellation, the other from the product of roots c / a. */
static bool roots_of(double a, double b, double c, double t[2])
{
    const double left = b * b - a * c;
    if (!(left >= 0)) return false;
    const double q = b < 0 ? -b + sqrt(left) : -b - sqrt(left);
    t[0] = a != 0 ? q / a : INFINITY, t[1] = q != 0 ? c / q : INFINITY;
    return true;
}

static bool meets_sphere(const WrShape *shape, WrVec3 o, WrVec3 d, double most)
{
    const double R = shape->value[0];
    double t[2];
    if (!roots_of(v3_dot(d, d), v3_dot(o, d), v3_dot(o, o) - R * R, t)) return false;
    return (t[0] > 0 && t[0] < most) || (t[1] > 0 && t[1] < most);
}

/* Open tube or cone: x^2 + y^2 = (r + k w)^2, with w = z measured from the middle, within half the height.
   w.r.t. the middle: a cylinder has k = 0, a cone k = -R / H and r = R / 2. */
static bool meets_tube(double r, double k, double H, WrVec3 o, WrVec3 d, double most)
{
    const double wide = r + k * o.z, grows = k * d.z;
    double t[2];
    if (!roots_of(d.x * d.x + d.y * d.y - grows * grows, o.x * d.x + o.y * d.y - wide * grows,
                  o.x * o.x + o.y * o.y - wide * wide, t))
        return false;
    for (int i = 0; i < 2; i++)
        if (t[i] > 0 && t[i] < most && fabs(o.z + t[i] * d.z) <= H / 2) return true;
    return false;
}

/* True if the ray o + t d, object units, d of any length, hits the body for 0 < t < most. */
static bool shadow_rays_meets(const WrShadowRaysBody *body, WrVec3 o, WrVec3 d, double most)
{
    const double *value = body->shape.value;
    if (body->tree) return wr_ray_tree_any(body->tree, o, d, most);
    switch (wr_surfaces[body->shape.kind]->inversion) {
    case WR_INVERT_PLANE:
    case WR_INVERT_CUBE: return meets_quads(body, o, d, most);
    case WR_INVERT_SPHERE: return meets_sphere(&body->shape, o, d, most);
    case WR_INVERT_CYLINDER: return meets_tube(value[0], 0, value[1], o, d, most);
    case WR_INVERT_CONE:
        return meets_tube(value[0] / 2, -value[0] / value[1], value[1], o, d, most);
    case WR_INVERT_MESH:
        return shadow_rays_meets_torus(&body->shape, o, d, most); /* all others have facets */
    case WR_INVERT_TRIANGLES: break;
    }
    return false;
}

/* ---- bodies ---- */

void wr_shadow_rays_body_fini(WrShadowRaysBody *body)
{
    wr_triangles_free(body->triangles);
    wr_ray_tree_free(body->tree);
    *body = (WrShadowRaysBody){ 0 };
}

/* Keeps the built geometry if shape, relief and mesh are those of the last frame; otherwise frees it, and it
   is rebuilt on demand. */
static void shadow_rays_body_size(WrShadowRaysBody *body, const WrScene *scene,
                                  const WrField *field, bool moves)
{
    const WrTriangles *held = scene->triangles;
    const bool moved = moves && wr_is_raised(scene);
    const WrHash raised = moved ? wr_raised_key(scene, field) : (WrHash){ 0, 0 };
    const bool same = body->radius > 0 && wr_hash_equal(body->raised, raised) &&
                      memcmp(&body->shape, &scene->shape, sizeof body->shape) == 0;
    if (same && (!body->triangles || !held || moved || held->key == body->triangles->key)) return;
    wr_shadow_rays_body_fini(body);
    body->shape = scene->shape;
    body->radius = wr_shape_radius(&scene->shape);
    body->raised = raised;
    if (moved) body->rise = wr_raised_most(scene, field);
}

/* Of the object's radius: more than the error of single-precision positions. */
#define ROUNDING 0x1p-19
/* Of the object's radius, for surfaces that are drawn as patches and cast shadows as the triangles cut from them. */
#define PATCHY 0x1p-10

/* Of the mesh surfaces only the torus has a closed form. */
static bool needs_facets(const WrShadowRaysBody *body)
{
    const bool mesh = wr_surfaces[body->shape.kind]->inversion == WR_INVERT_MESH;
    return body->rise > 0 || (mesh && body->shape.kind != WR_SURFACE_torus);
}

static bool shadow_rays_body_update(WrShadowRaysBody *body, const WrScene *scene,
                                    const WrField *field, WrError *err)
{
    const WrInversion how = wr_surfaces[scene->shape.kind]->inversion;
    if (body->made) return true;
    body->lift = ROUNDING * body->radius;
    if (wr_surfaces[scene->shape.kind]->held && body->rise > 0) {
        if (!shadow_rays_mesh_relief(body, scene, field, err)) return false;
    } else if (wr_surfaces[scene->shape.kind]->held) {
        body->triangles =
            scene->triangles ? wr_triangles_share(scene->triangles) : wr_triangles_square();
        if (body->triangles->patches) body->lift = PATCHY * body->radius;
    } else if (needs_facets(body)) {
        if (!shadow_rays_facets(body, scene, field, err)) return false;
    } else if (how == WR_INVERT_PLANE || how == WR_INVERT_CUBE) {
        take_quads(body);
    }
    if (body->triangles) {
        body->tree = wr_ray_tree_new(body->triangles, 0, body->triangles->triangle_count, err);
        if (!body->tree) wr_triangles_free(body->triangles), body->triangles = NULL;
        return body->made = body->tree != NULL;
    }
    return body->made = true;
}

/* ---- lamps ---- */

/* True if the caster may block the lamp: tests its bounding sphere against the cone of rays to the lamp.
   The squared distance of the sphere's centre from the axis of the cone, against the sphere's radius plus the
   cone's widest part before the sphere's far end. */
static bool may_meet(const WrShadowRaysTo *to, WrVec3 p, WrVec3 l, double away, double spread)
{
    const WrVec3 off = v3_sub(to->middle, p);
    const double along = v3_dot(off, l), r = to->radius;
    if (!(r < INFINITY)) return true;
    if (along < -r || along - r > away) return false;
    const double reach = r + spread * fmax(along + r, 0);
    return v3_dot(off, off) - along * along <= reach * reach * (1 + 1e-9);
}

static bool is_hidden(const WrShadowRaysTo *to, WrVec3 p, WrVec3 l, double away)
{
    const double *m = to->m;
    const WrVec3 o = { m[0] * p.x + m[1] * p.y + m[2] * p.z + to->from.x,
                       m[3] * p.x + m[4] * p.y + m[5] * p.z + to->from.y,
                       m[6] * p.x + m[7] * p.y + m[8] * p.z + to->from.z };
    const WrVec3 d = { m[0] * l.x + m[1] * l.y + m[2] * l.z, m[3] * l.x + m[4] * l.y + m[5] * l.z,
                       m[6] * l.x + m[7] * l.y + m[8] * l.z };
    return shadow_rays_meets(to->body, o, d, away);
}

/* True if any caster blocks that point of the lamp.
   The own body is tested only along or above the tangent plane: see is_blocked in reference_shade.c for the
   reason. */
static bool any_hides(const WrShadowRays *cast, const int *near, int count, WrVec3 p, WrVec3 n,
                      WrVec3 l, double away)
{
    const double up = v3_dot(n, l);
    const WrVec3 level = up < 0 ? v3_mad(l, n, -up) : l;
    for (int k = 0; k < count; k++) {
        const WrShadowRaysTo *to = &cast->to[near[k]];
        if (is_hidden(to, p, to->own ? level : l, away)) return true;
    }
    return false;
}

/* The casters near the cone of this lamp are collected once for all points of an area lamp. `lift` moves the
   start off the surface by more than the error of facets and of single-precision positions. */
double wr_shadow_rays_share(const WrShadowRays *cast, int count, WrVec3 p, WrVec3 n, WrVec3 l,
                            double away, double radius)
{
    int near[WR_OBJECTS_MAX], nearby = 0, seen = 0;
    const WrVec3 from = v3_mad(p, n, cast->lift);
    const bool round = radius > 0 && cast->rays > 1;
    double sine = 0, cosine = 1;
    if (round) wr_sincos_turns(radius / (2 * WR_PI), &sine, &cosine);
    const double spread = sine / cosine;
    for (int i = 0; i < count; i++)
        if (may_meet(&cast->to[i], from, l, away, spread)) near[nearby++] = i;
    if (nearby == 0) return 1;
    if (!round) return any_hides(cast, near, nearby, from, n, l, away) ? 0 : 1;
    const WrVec3 least = fabs(l.x) < 0.6 ? (WrVec3){ 1, 0, 0 } : (WrVec3){ 0, 1, 0 };
    const WrVec3 a = v3_unit(v3_cross(l, least), least), b = v3_cross(l, a);
    for (int k = 0; k < cast->rays; k++) {
        const WrVec3 aside = v3_mad(v3_scale(a, cast->disc[k][0]), b, cast->disc[k][1]);
        const WrVec3 to = v3_unit(v3_mad(l, aside, spread), l);
        seen += !any_hides(cast, near, nearby, from, n, to, away);
    }
    return (double)seen / cast->rays;
}
