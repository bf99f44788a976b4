/* Baking: a displaced sphere and torus baked back onto the smooth one, normals against those of the formula, mirrored
   islands, holes, samples, parts of equal names. */
#include "test.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/vec.h"
#include "surface/bake.h"
#include "surface/tangent_frames.h"
#include "surface/triangles.h"

#include <math.h>
#include <string.h>

/* ---- meshes ---- */

typedef double Height(const void *ctx, double u, double v);

/* A sphere of radius 1, or a torus of radii 1 and 0.35, in cells between lines of u and v, displaced along its normal. */
typedef struct Form {
    bool torus;
    int across, down; /* lines: across + 1, down + 1 */
    double u0, v0;    /* of the first lines, in cells */
    Height *height;   /* NULL: 0 */
    const void *ctx;
    bool normals;  /* the mesh has those of the undisplaced surface */
    bool mirrored; /* texture coordinates of u > 1/2 run backwards */
    int hole[4];   /* cells left out: from and up to, across and down */
} Form;

static WrVec3 normal_at(bool torus, double u, double v)
{
    const double a = 2 * M_PI * u, b = torus ? 2 * M_PI * v : M_PI * v;
    const bool pole = !torus && (v == 0 || v == 1); /* one point, whatever u */
    const double out = torus ? cos(b) : pole ? 0 : sin(b), up = torus ? sin(b) : -cos(b);
    return (WrVec3){ cos(a) * out, sin(a) * out, up };
}

static WrVec3 point_at(bool torus, double u, double v, double f)
{
    const WrVec3 n = normal_at(torus, u, v), ring = { cos(2 * M_PI * u), sin(2 * M_PI * u), 0 };
    return torus ? v3_mad(ring, n, 0.35 + f) : v3_scale(n, 1 + f);
}

/* Arrays of a mesh that grows. */
typedef struct Arrays {
    float (*points)[3], (*normals)[3], (*uv)[2];
    int32_t (*corners)[3];
    WrTrianglePart parts[4];
    int point_count, triangle_count, part_count;
} Arrays;

static Arrays arrays_new(int points, int triangles)
{
    Arrays a = { 0 };
    a.points = wr_alloc((size_t)points, sizeof *a.points);
    a.normals = wr_alloc((size_t)points, sizeof *a.normals);
    a.uv = wr_alloc((size_t)points, sizeof *a.uv);
    a.corners = wr_alloc((size_t)triangles, sizeof *a.corners);
    return a;
}

static int add_point(Arrays *a, WrVec3 p, WrVec3 n, double u, double v)
{
    const int i = a->point_count++;
    a->points[i][0] = (float)p.x, a->points[i][1] = (float)p.y, a->points[i][2] = (float)p.z;
    a->normals[i][0] = (float)n.x, a->normals[i][1] = (float)n.y, a->normals[i][2] = (float)n.z;
    a->uv[i][0] = (float)u, a->uv[i][1] = (float)v;
    return i;
}

static void add_square(Arrays *a, int p, int q, int r, int s)
{
    const int32_t one[3] = { p, q, r }, two[3] = { p, r, s };
    memcpy(a->corners[a->triangle_count++], one, sizeof one);
    memcpy(a->corners[a->triangle_count++], two, sizeof two);
}

static WrTriangles *arrays_done(Arrays *a, bool normals)
{
    WrError err = { "" };
    const WrTrianglesSource source = { .points = (const float(*)[3])a->points,
                                       .normals = normals ? (const float(*)[3])a->normals : NULL,
                                       .uv = (const float(*)[2])a->uv,
                                       .corners = (const int32_t(*)[3])a->corners,
                                       .point_count = a->point_count,
                                       .triangle_count = a->triangle_count,
                                       .parts = a->part_count ? a->parts : NULL,
                                       .part_count = a->part_count };
    WrTriangles *mesh = wr_triangles_new(&source, &err);
    if (!mesh) fail_msg("%s", err.text);
    wr_free(a->points);
    wr_free(a->normals);
    wr_free(a->uv);
    wr_free(a->corners);
    return mesh;
}

static WrTriangles *form_mesh(const Form *form)
{
    const int lines = form->across + 1, rows = form->down + 1;
    Arrays a = arrays_new(2 * lines * rows, 2 * form->across * form->down);
    for (int half = 0; half < (form->mirrored ? 2 : 1); half++)
        for (int j = 0; j < rows; j++)
            for (int i = 0; i < lines; i++) {
                const double u = (i + form->u0) / form->across, v = (j + form->v0) / form->down;
                const double f = form->height ? form->height(form->ctx, u, v) : 0;
                add_point(&a, point_at(form->torus, u, v, f), normal_at(form->torus, u, v),
                          half ? 1.5 - u : u, v);
            }
    for (int j = 0; j < form->down; j++)
        for (int i = 0; i < form->across; i++) {
            const bool back = form->mirrored && 2 * i >= form->across;
            const int p = j * lines + i + (back ? lines * rows : 0);
            if (i >= form->hole[0] && i < form->hole[1] && j >= form->hole[2] && j < form->hole[3])
                continue;
            add_square(&a, p, p + 1, p + lines + 1, p + lines);
        }
    return arrays_done(&a, form->normals);
}

static float *bake(const WrTriangles *low, const WrTriangles *high, WrBakeOptions options,
                   WrBakeReport *report)
{
    WrError err = { "" };
    if (options.samples == 0) options.samples = 1;
    float *map = wr_bake(low, high, &options, report, &err);
    if (!map) fail_msg("%s", err.text);
    return map;
}

/* ---- heights ---- */

enum { WIDE = 129, TALL = 67 };

typedef struct Table {
    double f[TALL][WIDE]; /* row 0 on top */
} Table;

/* The table at its texels' centres. */
static double table_height(const void *ctx, double u, double v)
{
    const Table *table = ctx;
    const int i = (int)floor(WIDE * u), j = (int)floor(TALL * (1 - v));
    if (j < 0 || j >= TALL) return 0;
    return table->f[j][(i % WIDE + WIDE) % WIDE];
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

/* Both meshes have their vertices at the texels' centres, so that the rays run along the formula's normals and through
   the vertices of the displaced mesh. */
static void returns_the_table(bool torus)
{
    TestRandom random = { torus ? 3 : 4 };
    Table *table = wr_alloc(1, sizeof *table);
    for (int j = 0; j < TALL; j++)
        for (int i = 0; i < WIDE; i++) table->f[j][i] = 0.1 * test_random(&random) - 0.03;
    /* The sphere is open beyond the outer rows. */
    const int down = torus ? TALL : TALL - 1;
    Arrays low = arrays_new((WIDE + 1) * (TALL + 1), 2 * WIDE * TALL);
    Arrays high = arrays_new((WIDE + 1) * (TALL + 1), 2 * WIDE * TALL);
    for (int j = 0; j <= down; j++)
        for (int i = 0; i <= WIDE; i++) {
            const double u = (i + 0.5) / WIDE, v = (j + 0.5) / TALL;
            const double f = table_height(table, u, j < TALL ? v : v - 1);
            const double at = torus || j < TALL ? v : 1;
            const WrVec3 n = normal_at(torus, i < WIDE ? u : u - 1, at);
            add_point(&low, point_at(torus, i < WIDE ? u : u - 1, at, 0), n, u, v);
            add_point(&high, point_at(torus, i < WIDE ? u : u - 1, at, f), n, u, v);
        }
    for (int j = 0; j < down; j++)
        for (int i = 0; i < WIDE; i++) {
            const int p = j * (WIDE + 1) + i;
            add_square(&low, p, p + 1, p + WIDE + 2, p + WIDE + 1);
            add_square(&high, p, p + 1, p + WIDE + 2, p + WIDE + 1);
        }
    WrTriangles *simple = arrays_done(&low, true), *detailed = arrays_done(&high, true);
    WrBakeReport report;
    WrPool *pool = wr_pool_new(2);
    float *map = bake(simple, detailed,
                      (WrBakeOptions){ .width = WIDE, .height = TALL, .pool = pool }, &report);
    /* Rays on the sphere's open edge may pass it. */
    assert_true(report.missed <= (torus ? 0 : 2 * WIDE));
    assert_true(report.texels >= WIDE * (TALL - 2));
    assert_true(report.cage > 0.07 && report.cage < 0.3);
    double *off = wr_alloc((size_t)WIDE * TALL, sizeof *off);
    double x = 0, y = 0, xx = 0, yy = 0, xy = 0;
    int count = 0;
    for (int j = torus ? 0 : 1; j < (torus ? TALL : TALL - 1); j++)
        for (int i = 0; i < WIDE; i++) {
            const double a = table->f[j][i], b = (double)map[j * WIDE + i];
            off[count++] = fabs(a - b);
            x += a, y += b, xx += a * a, yy += b * b, xy += a * b;
        }
    qsort(off, (size_t)count, sizeof *off, ascending);
    const double correlation =
        (count * xy - x * y) / sqrt((count * xx - x * x) * (count * yy - y * y));
    if (getenv("WRINKLE_FIGURES"))
        printf(
            "%s: correlation 1 - %.2g, error median %.2g, 99%% %.2g, most %.2g codes of 16 bits\n",
            torus ? "torus" : "sphere", 1 - correlation, off[count / 2] * 65535 / 0.1,
            off[count * 99 / 100] * 65535 / 0.1, off[count - 1] * 65535 / 0.1);
    assert_true(correlation >= 0.999);
    assert_true(off[count / 2] < 0.5 * 0.1 / 65535);
    /* Threads change no bit. */
    WrBakeReport again;
    float *alone = bake(simple, detailed, (WrBakeOptions){ .width = WIDE, .height = TALL }, &again);
    assert_memory_equal(map, alone, sizeof(float) * WIDE * TALL);
    wr_free(alone);
    wr_free(map);
    wr_free(off);
    wr_pool_free(pool);
    wr_triangles_free(simple);
    wr_triangles_free(detailed);
    wr_free(table);
}

static void a_displaced_sphere_returns_the_table(void **state)
{
    (void)state;
    returns_the_table(false);
}

static void a_displaced_torus_returns_the_table(void **state)
{
    (void)state;
    returns_the_table(true);
}

/* ---- normals ---- */

static double waves(const void *ctx, double u, double v)
{
    (void)ctx;
    return 0.03 * sin(2 * M_PI * 5 * u) * sin(M_PI * 6 * v) +
           0.01 * cos(2 * M_PI * (3 * u + 0.1)) * sin(M_PI * v);
}

/* Of the displaced sphere, at the point in a direction. */
static WrVec3 true_normal(WrVec3 p)
{
    const double turns = atan2(p.y, p.x) / (2 * M_PI), v = acos(-p.z / v3_len(p)) / M_PI;
    const double u = turns < 0 ? turns + 1 : turns, h = 1e-5;
    const WrVec3 pu = v3_sub(point_at(false, u + h, v, waves(NULL, u + h, v)),
                             point_at(false, u - h, v, waves(NULL, u - h, v)));
    const WrVec3 pv = v3_sub(point_at(false, u, v + h, waves(NULL, u, v + h)),
                             point_at(false, u, v - h, waves(NULL, u, v - h)));
    return v3_unit(v3_cross(pu, pv), p);
}

enum { SIDE = 160 };

static WrVec3 texel(const float *map, int x, int y)
{
    const float *t = map + 3 * (y * SIDE + x);
    return (WrVec3){ (double)t[0], (double)t[1], (double)t[2] };
}

/* The normal that a program shades with: interpolated tangent and normal, bitangent from both. */
static WrVec3 shaded(const WrTriangles *mesh, const WrTangent *frames, int i, const double l[3],
                     WrVec3 n)
{
    WrVec3 vt = { 0, 0, 0 }, vn = { 0, 0, 0 };
    for (int k = 0; k < 3; k++) {
        const float *m = mesh->corners[mesh->triangles[i].corner[k]].n;
        vt = v3_mad(vt, frames[3 * i + k].t, l[k]);
        vn = v3_mad(vn, (WrVec3){ (double)m[0], (double)m[1], (double)m[2] }, l[k]);
    }
    const WrVec3 vb = v3_scale(v3_cross(vn, vt), frames[3 * i].sign);
    return v3_unit(v3_mad(v3_mad(v3_scale(vt, n.x), vb, n.y), vn, n.z), vn);
}

/* Angles at the texels inside of a triangle, by its own barycentric coordinates. */
static int angles_in(const WrTriangles *mesh, const WrTangent *frames, int i, const float *normals,
                     const float *positions, double *angle)
{
    const WrTriangleCorner *c[3];
    int count = 0;
    for (int k = 0; k < 3; k++) c[k] = &mesh->corners[mesh->triangles[i].corner[k]];
    const double e = (double)(c[1]->u - c[0]->u), f = (double)(c[2]->u - c[0]->u);
    const double g = (double)(c[1]->v - c[0]->v), h = (double)(c[2]->v - c[0]->v);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            const double u = (x + 0.5) / SIDE - (double)c[0]->u;
            const double v = 1 - (y + 0.5) / SIDE - (double)c[0]->v, det = e * h - f * g;
            const double a = (u * h - f * v) / det, b = (e * v - u * g) / det;
            const double l[3] = { 1 - a - b, a, b };
            if (!(l[0] > 0.01 && a > 0.01 && b > 0.01)) continue;
            const WrVec3 p = texel(positions, x, y), half = { 0.5, 0.5, 0.5 };
            const double *m = mesh->centre;
            const WrVec3 hit =
                v3_mad((WrVec3){ m[0], m[1], m[2] }, v3_sub(p, half), 2 * mesh->radius);
            const WrVec3 n = shaded(mesh, frames, i, l, texel(normals, x, y));
            angle[count++] =
                atan2(v3_len(v3_cross(n, true_normal(hit))), v3_dot(n, true_normal(hit))) * 180 /
                M_PI;
        }
    return count;
}

static void compare_normals(bool mirrored, bool coarse)
{
    WrError err = { "" };
    Form low = {
        .across = coarse ? 24 : 60, .down = coarse ? 12 : 30, .normals = true, .mirrored = mirrored
    };
    Form high = { .across = 400, .down = 200, .height = waves };
    WrTriangles *simple = form_mesh(&low), *detailed = form_mesh(&high);
    WrBakeReport report;
    WrBakeOptions options = { .kind = WR_BAKE_NORMAL, .width = SIDE, .height = SIDE };
    float *normals = bake(simple, detailed, options, &report);
    assert_int_equal(report.missed + report.frameless, 0);
    options.kind = WR_BAKE_POSITION;
    float *positions = bake(simple, detailed, options, &report);
    WrTangent *frames = wr_alloc(3 * (size_t)simple->triangle_count, sizeof *frames);
    assert_true(
        wr_tangents_mikk(simple->corners, simple->triangles, simple->triangle_count, frames, &err));
    double *angle = wr_alloc((size_t)SIDE * SIDE * 2, sizeof *angle);
    int count = 0;
    for (int i = 0; i < simple->triangle_count; i++)
        count += angles_in(simple, frames, i, normals, positions, angle + count);
    assert_true(count > SIDE * SIDE / 2);
    qsort(angle, (size_t)count, sizeof *angle, ascending);
    if (getenv("WRINKLE_FIGURES"))
        printf("normals%s%s: median %.3g, 99%% %.3g, most %.3g degrees\n",
               mirrored ? ", mirrored" : "", coarse ? ", coarse" : "", angle[count / 2],
               angle[count * 99 / 100], angle[count - 1]);
    assert_true(angle[count / 2] <= 0.2);
    assert_true(angle[count * 99 / 100] <= 2);
    wr_free(angle);
    wr_free(frames);
    wr_free(normals);
    wr_free(positions);
    wr_triangles_free(simple);
    wr_triangles_free(detailed);
}

static void normals_are_those_of_the_displaced_sphere(void **state)
{
    (void)state;
    if (test_amount(1, 0)) compare_normals(false, false);
    compare_normals(false, true);
}

static void mirrored_islands_have_frames_of_their_own(void **state)
{
    (void)state;
    compare_normals(true, true);
}

/* ---- misses, samples, parts ---- */

static double constant(const void *ctx, double u, double v)
{
    (void)u, (void)v;
    return *(const double *)ctx;
}

static void texels_over_a_hole_are_counted_and_padded(void **state)
{
    (void)state;
    const double f = 0.05;
    /* Texels lie inside of cells, 13 x 10 of which are missing. */
    Form low = { .across = WIDE, .down = TALL, .normals = true };
    Form high = {
        .across = WIDE, .down = TALL, .height = constant, .ctx = &f, .hole = { 40, 53, 20, 30 }
    };
    WrTriangles *simple = form_mesh(&low), *detailed = form_mesh(&high);
    WrBakeReport report;
    WrBakeOptions options = { .width = WIDE, .height = TALL, .padding = 2 };
    float *map = bake(simple, detailed, options, &report);
    assert_true(report.texels > WIDE * (TALL - 2));
    assert_int_equal(report.missed, 13 * 10);
    assert_int_equal(report.backs, 0);
    for (int j = 20; j < 30; j++) /* rows from below */
        for (int i = 40; i < 53; i++) {
            const int ring = (int)fmin(fmin(i - 39, 53 - i), fmin(j - 19, 30 - j));
            const double at = (double)map[(TALL - 1 - j) * WIDE + i];
            assert_near(at, ring <= 2 ? 0.05 : 0, ring <= 2 ? 2e-4 : 0);
        }
    wr_free(map);
    /* From a cage of the whole body the rays meet the far side from within. */
    options.cage = 3;
    options.kind = WR_BAKE_HITS;
    map = bake(simple, detailed, options, &report);
    assert_int_equal(report.missed, 13 * 10);
    assert_int_equal(report.backs, 13 * 10);
    int blue = 0;
    for (int i = 0; i < WIDE * TALL; i++) blue += map[3 * i + 2] > 0.5f;
    assert_int_equal(blue, 13 * 10);
    wr_free(map);
    wr_triangles_free(simple);
    wr_triangles_free(detailed);
}

/* A square at a height, (u,v) from u0 to u1. */
static void add_plane(Arrays *a, const char *name, double x0, double x1, double z, double u0,
                      double u1)
{
    const WrVec3 up = { 0, 0, 1 };
    const int p = add_point(a, (WrVec3){ x0, 0, z }, up, u0, 0);
    add_point(a, (WrVec3){ x1, 0, z }, up, u1, 0);
    add_point(a, (WrVec3){ x1, 1, z }, up, u1, 1);
    add_point(a, (WrVec3){ x0, 1, z }, up, u0, 1);
    WrTrianglePart *part = &a->parts[a->part_count++];
    *part = (WrTrianglePart){ .first = a->triangle_count, .count = 2 };
    snprintf(part->name, sizeof part->name, "%s", name);
    add_square(a, p, p + 1, p + 2, p + 3);
}

static void samples_are_averaged_over_the_texel(void **state)
{
    (void)state;
    Arrays a = arrays_new(8, 4), b = arrays_new(8, 4);
    add_plane(&a, "", 0, 1, 0, 0, 1);
    /* A step at 1/4 of texel 3 of 8: three of four samples are above. */
    add_plane(&b, "", 0, 3.25 / 8, 0, 0, 1);
    add_plane(&b, "", 3.25 / 8, 1, 0.125, 0, 1);
    WrTriangles *simple = arrays_done(&a, true), *detailed = arrays_done(&b, true);
    WrBakeReport report;
    float *map =
        bake(simple, detailed, (WrBakeOptions){ .width = 8, .height = 5, .samples = 4 }, &report);
    for (int i = 0; i < 40; i++)
        assert_near((double)map[i], i % 8 < 3 ? 0 : i % 8 > 3 ? 0.125 : 0.75 * 0.125, 1e-7);
    assert_int_equal(report.texels, 40);
    wr_free(map);
    wr_triangles_free(simple);
    wr_triangles_free(detailed);
}

static void parts_meet_those_of_their_name(void **state)
{
    (void)state;
    for (int match = 0; match < 2; match++) {
        Arrays a = arrays_new(12, 6), b = arrays_new(12, 6);
        add_plane(&a, "floor_low", 0, 1, 0, 0, 0.5);
        add_plane(&a, "shelf_low", 0, 1, 0.5, 0.5, 0.75);
        add_plane(&a, "lamp_low", 2, 3, 0, 0.75, 1);
        add_plane(&b, "shelf_high", 0, 1, 0.625, 0, 1);
        add_plane(&b, "floor", 0, 1, 0.25, 0, 1); /* of both, the first that is hit */
        add_plane(&b, "floor_high", 0, 1, 0.1875, 0, 1);
        WrTriangles *simple = arrays_done(&a, true), *detailed = arrays_done(&b, true);
        WrBakeReport report;
        float *map = bake(
            simple, detailed,
            (WrBakeOptions){ .width = 16, .height = 3, .cage = 0.875, .match = match }, &report);
        for (int i = 0; i < 48; i++) {
            const double floor = match ? 0.25 : 0.625;
            assert_near((double)map[i], i % 16 < 8 ? floor : i % 16 < 12 ? 0.125 : 0, 1e-7);
        }
        assert_int_equal(report.missed, 12);
        assert_int_equal(report.alone, match);
        wr_free(map);
        wr_triangles_free(simple);
        wr_triangles_free(detailed);
    }
}

/* Two planes at a right angle: at distance x from an endless wall of height 1 the floor is open to
   (1 + x / sqrt(x^2 + 1)) / 2 of the sky, cosine-weighted. */
static void occlusion_is_that_of_a_wall(void **state)
{
    (void)state;
    Arrays a = arrays_new(4, 2), b = arrays_new(8, 4);
    add_plane(&a, "", 0, 1, 0, 0, 1);
    add_plane(&b, "", 0, 1, 0, 0, 1);
    const WrVec3 along = { 1, 0, 0 };
    const int p = add_point(&b, (WrVec3){ 0, -50, 0 }, along, 0, 0);
    add_point(&b, (WrVec3){ 0, 50, 0 }, along, 0, 0);
    add_point(&b, (WrVec3){ 0, 50, 1 }, along, 0, 0);
    add_point(&b, (WrVec3){ 0, -50, 1 }, along, 0, 0);
    b.parts[0].count = 4;
    add_square(&b, p, p + 1, p + 2, p + 3);
    WrTriangles *simple = arrays_done(&a, true), *detailed = arrays_done(&b, true);
    WrBakeReport report;
    float *map =
        bake(simple, detailed,
             (WrBakeOptions){
                 .kind = WR_BAKE_OCCLUSION, .width = 8, .height = 8, .samples = 4, .cage = 0.01 },
             &report);
    for (int i = 0; i < 8; i++) {
        const double x = (i + 0.5) / 8;
        assert_near((double)map[32 + i], 0.5 + 0.5 * x / sqrt(x * x + 1), 0.02);
    }
    wr_free(map);
    wr_triangles_free(simple);
    wr_triangles_free(detailed);
}

static void curvature_is_bright_on_a_ball_and_dark_inside_one(void **state)
{
    (void)state;
    Form form = { .across = 90, .down = 45, .normals = true };
    WrTriangles *ball = form_mesh(&form);
    WrBakeReport report;
    WrBakeOptions options = { .kind = WR_BAKE_CURVATURE, .width = 16, .height = 8, .cage = 0.1 };
    float *map = bake(ball, ball, options, &report);
    /* Mean curvature 1 and radius 1: x = 1/20. */
    for (int i = 0; i < 128; i++) assert_near((double)map[i], 0.5 + 0.5 * 0.05 / 1.05, 1e-3);
    wr_free(map);
    wr_triangles_free(ball);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_displaced_sphere_returns_the_table),
        cmocka_unit_test(a_displaced_torus_returns_the_table),
        cmocka_unit_test(normals_are_those_of_the_displaced_sphere),
        cmocka_unit_test(mirrored_islands_have_frames_of_their_own),
        cmocka_unit_test(texels_over_a_hole_are_counted_and_padded),
        cmocka_unit_test(samples_are_averaged_over_the_texel),
        cmocka_unit_test(parts_meet_those_of_their_name),
        cmocka_unit_test(occlusion_is_that_of_a_wall),
        cmocka_unit_test(curvature_is_bright_on_a_ball_and_dark_inside_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
