/* Facets of a surface without closed-form intersection, or of a displaced one. Their error is a few
   hundred-thousandths of its radius. */
#include "base/error.h"
#include "base/memory.h"
#include "field/field.h"
#include "render/shadows/shadow_rays.h"
#include "render/tessellation/displacement_lookup.h"
#include "surface/triangles.h"

#include <math.h>

#define OFF 0x1p-15 /* of the radius: error that facets may have, if ... */
#define MOST 512    /* ... this many steps are enough */
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
    double rows[MOST + CORNERS + 1];
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

/* Largest distance of a step's middle from its chord, with n steps along u or v. */
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

/* Largest distance of a cell's centre from the diagonal along which the cell is cut. */
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
    return (int)fmin(fmax(LEAST, of * texels), MOST);
}

static int steps_of(const Cut *cut, bool along_u, double enough)
{
    int n = least_steps(cut, along_u);
    while (n < MOST && off_by(cut, along_u, n) > enough) n *= 2;
    return n < MOST ? n : MOST;
}

/* Chooses the steps in both directions; returns their error. */
static int choose_steps(Cut *cut, double enough)
{
    int across = steps_of(cut, true, enough), down = steps_of(cut, false, enough);
    while ((across < MOST || down < MOST) && off_across(cut, across, down) > 2 * enough) {
        across = 2 * across < MOST ? 2 * across : MOST;
        down = 2 * down < MOST ? 2 * down : MOST;
    }
    cut->across = across;
    cut->off =
        fmax(off_across(cut, across, down), off_by(cut, true, across) + off_by(cut, false, down));
    return down;
}

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
    body->lift += 2 * off;
    wr_free(facets.points);
    wr_free(facets.corners);
    wr_free(cuts);
    return body->triangles != NULL;
}

bool wr_shadow_rays_facets(WrShadowRaysBody *body, const WrScene *scene, const WrField *field,
                           WrError *err)
{
    WrRaised raised = { 0 };
    if (!(body->rise > 0)) return facets_of(body, NULL, err);
    const bool good = wr_raised_init(&raised, scene, field, err) && facets_of(body, &raised, err);
    wr_raised_fini(&raised);
    return good;
}
