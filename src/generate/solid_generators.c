/* Solids drawn into the table: closed forms, letters, surfaces and meshes. */
#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "field/field.h"
#include "generate/generator.h"
#include "generate/sheet.h"
#include "generate/solid_places.h"
#include "generate/text_relief.h"
#include "generate/tile_builder.h"
#include "generate/zbuffer.h"
#include "image/font.h"
#include "image/image.h"
#include "image/mesh.h"
#include "surface/data.h"
#include "surface/surface.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

/* ---- shared parts ---- */

#define WR_S_TUPLE(n, l, v, lowest, highest, soft_lowest, soft_highest, u, s, h)                   \
    {                                                                                              \
        .name = (n), .label = (l), .help = (h), .unit = (u), .kind = WR_PARAM_TUPLE,               \
        .fallback = { (v), (v), (v) }, .low = (lowest), .high = (highest),                         \
        .soft_low = (soft_lowest), .soft_high = (soft_highest), .shape = (s),                      \
        .components = sizeof(s) == sizeof "x,y,z" ? 3 : 2                                          \
    }
#define WR_S_ABOVE(n, l, v, soft, s, h)                                                            \
    {                                                                                              \
        .name = (n), .label = (l), .help = (h), .unit = "texels", .kind = WR_PARAM_TUPLE,          \
        .fallback = { (v), (v), (v) }, .low = 0, .above = true, .high = 16384, .soft_low = 0,      \
        .soft_high = (soft), .shape = (s), .components = 3                                         \
    }
#define WR_S_RADIUS(n, l, v, h) WR_P_ABOVE(n, l, v, 0, 16384, 256, "texels", h)

/* Common parameters, after those of the solid. */
#define WR_S_POSE                                                                                  \
    WR_S_TUPLE("at", "At", 0.5, -16, 16, 0, 1, "", "u,v", "position of its centre"),               \
        WR_S_TUPLE("rotate", "Rotate", 0, -36000, 36000, -180, 180, "degrees", "x,y,z",            \
                   "rotation about the axes x, y, z, in that order")
#define WR_S_HEIGHT(h)                                                                             \
    WR_P_NUMBER("height", "Height", 1, -WR_PARAM_HEIGHT, WR_PARAM_HEIGHT, 1, "table units", h)
#define WR_S_PLACE                                                                                 \
    WR_P_NUMBER("sink", "Sink", 0, -16384, 16384, 64, "texels",                                    \
                "depth to which it is sunk into the ground"),                                      \
        WR_P_TEXELS("deep", "Random depth", 0, 64, "largest random extra depth"),                  \
        WR_P_TEXELS("soft", "Edge fade", 0, 16,                                                    \
                    "height above the ground up to which its edge fades"),                         \
        WR_P_WHOLE("across", "Across", 1, 1, WR_SOLID_MAX, 32, "number of copies side by side"),   \
        WR_P_WHOLE("rows", "Rows", 1, 1, WR_SOLID_MAX, 32, "number of copies above one another"),  \
        WR_S_TUPLE("spacing", "Spacing", 0, 0, 16384, 0, 256, "texels", "x,y",                     \
                   "distance between neighbours; 0: spread evenly over the table"),                \
        WR_P_PART("stagger", "Stagger", 0,                                                         \
                  "offset of every other row, as a share of the spacing"),                         \
        WR_P_TEXELS("jitter", "Jitter", 0, 32, "largest random displacement"),                     \
        WR_P_NUMBER("alternate", "Alternate", 0, -360, 360, 90, "degrees",                         \
                    "rotation of every other copy about its own x axis, as in a chain"),           \
        WR_P_NUMBER("turn", "Turn", 0, 0, 180, 180, "degrees",                                     \
                    "largest random rotation about the vertical"),                                 \
        WR_P_NUMBER("tilt", "Tilt", 0, 0, 180, 45, "degrees", "largest random tilt"),              \
        WR_P_NUMBER("vary", "Vary", 0, 0, 0.9, 0.9, "",                                            \
                    "random variation of size, as a share of it"),                                 \
        WR_P_SEED,                                                                                 \
        WR_P_CHOICE("layout", "Layout", WR_LAYOUT_GRID, layouts,                                   \
                    "grid: across by rows; hexagon: rows offset by half the spacing; chance: "     \
                    "random positions, no two nearer than the spacing"),                           \
        { .name = "points",                                                                        \
          .label = "Path",                                                                         \
          .help = "copies along a smooth curve through these points, rotated with it, at equal "   \
                  "distances near the spacing, so that a closed curve has no gap",                 \
          .unit = "",                                                                              \
          .kind = WR_PARAM_POINTS,                                                                 \
          .low = -64,                                                                              \
          .high = 64 },                                                                            \
        WR_P_SWITCH("closed", "Closed", 0, "on: the path is closed"),                              \
        WR_P_CHOICE(                                                                               \
            "join", "Overlap", JOIN_MAX, joins,                                                    \
            "overlapping copies. max: the highest; smooth: melted together; add: added up"),       \
        WR_P_ABOVE("melt", "Smoothing", 4, 0, 16384, 64, "texels",                                 \
                   "join=smooth: distance within which they melt together")
static const char *const layouts[] = { WR_LAYOUTS(WR_WORD) NULL };
#define JOINS(X) X(JOIN_MAX, "max") X(JOIN_SMOOTH, "smooth") X(JOIN_ADD, "add")
enum { JOINS(WR_WORD_ID) };
static const char *const joins[] = { JOINS(WR_WORD) NULL };

/* A triangle mesh to be placed. */
typedef struct WrSolidNet {
    const double (*points)[3];   /* [point_count], texels */
    const int32_t (*corners)[3]; /* [count] point indices */
    int64_t point_count, count;
} WrSolidNet;

/* ---- the rows that have files of their own ---- */

extern const WrParam wr_params_solid_mesh[], wr_params_solid_letters[], wr_params_solid_surface[];

/* Meshes from files, seen from above. */

/* ---- placement ---- */

/* Drawing of the copies that solid_places.h places. */

#define TRIANGLES_MAX 12000000 /* for all copies */

/* Draws the scene of `copies` with the parameters' height (for `rise` texels of z), cut at the ground. */
static bool solid_draw(const WrParams *params, WrZScene *scene, int64_t copies, double rise,
                       const WrGenerateJob *job, WrRelief *out, WrError *err)
{
    const int join = wr_param_whole(params, "join");
    scene->floor = 0.0;
    scene->soft = wr_param_number(params, "soft");
    scene->scale = wr_param_number(params, "height") / (rise > 0.0 ? rise : 1.0);
    if (join == JOIN_MAX || copies == 1) return wr_zbuffer_draw(scene, job, out, err);
    return wr_solid_join(scene, copies, join == JOIN_ADD ? 0.0 : wr_param_number(params, "melt"),
                         job, out, err);
}

/* Lowest and highest corner of the posed box, relative to its origin. pose[6..8] is the row of the rotation that makes z: the
   extreme of a linear function over a box is reached at a corner, axis by axis. */
static void letters_range(const WrZSolid *solid, double range[2])
{
    double low[3], high[3];
    wr_zletters_box(solid->letters, low, high);
    range[0] = range[1] = 0.0;
    for (int k = 0; k < 3; k++) {
        double p = solid->pose[6 + k] * low[k], q = solid->pose[6 + k] * high[k];
        range[0] += p < q ? p : q;
        range[1] += p < q ? q : p;
    }
}

/* Draws copies of one solid. letters: those of WR_Z_LETTERS, which stand on their lowest point; else NULL. */
static bool draw_copies(const WrParams *params, WrZShape shape, double param,
                        const WrZLetters *letters, const double size[3], const WrGenerateJob *job,
                        WrRelief *out, WrError *err)
{
    WrSolidPlace *places = NULL;
    int64_t count;
    double rise = 1.0;
    if (!wr_solid_places(params, job, &places, &count, err)) return false;
    WrZSolid *solids =
        wr_try_alloc((size_t)count, sizeof *solids, letters ? "letters" : "solids", err);
    bool good = solids;
    for (int64_t i = 0; good && i < count; i++) {
        const WrSolidPlace *p = &places[i];
        const double scaled[3] = { size[0] * p->scale, size[1] * p->scale, size[2] * p->scale };
        good = wr_zsolid_set(&solids[i], shape, param, letters, scaled, p->turn, p->at, err);
        if (!good) break;
        double range[2] = { 0.0, 0.0 };
        if (letters) letters_range(&solids[i], range);
        solids[i].at[2] -= range[0];
        if (i == 0) rise = (letters ? range[1] - range[0] : wr_zsolid_rise(&solids[0])) / p->scale;
    }
    WrZScene scene = { .solids = solids, .solid_count = count };
    good = good && solid_draw(params, &scene, count, rise, job, out, err);
    wr_free(solids);
    wr_free(places);
    return good;
}

/* ---- nets ---- */

typedef struct Copies {
    const WrSolidNet *net;
    const WrSolidPlace *places;
    double (*turned)[3]; /* [point_count] of the present copy */
} Copies;

/* For loops over a net: false after a cancellation, which is checked at intervals. The result is then incomplete. */
static bool goes_on(int64_t i)
{
    return i % 4096 != 0 || !wr_progress_stopped();
}

/* Rotates the points about the origin, y down; returns the lowest and the highest z. */
static void turn_points(const Copies *c, const WrSolidPlace *p, double range[2])
{
    for (int64_t i = 0; i < c->net->point_count && goes_on(i); i++) {
        const double *q = c->net->points[i];
        for (int k = 0; k < 3; k++) {
            const double *m = &p->turn[3 * k];
            double x = p->scale * (m[0] * q[0] + m[1] * q[1] + m[2] * q[2]);
            c->turned[i][k] = k == 2 ? x : wr_z_place(k == 1 ? -x : x);
        }
        double z = c->turned[i][2];
        range[0] = i == 0 || z < range[0] ? z : range[0];
        range[1] = i == 0 || z > range[1] ? z : range[1];
    }
}

static void put_copy(const Copies *c, const WrSolidPlace *p, double low, WrZTriangle *out)
{
    for (int64_t i = 0; i < c->net->count && goes_on(i); i++)
        for (int k = 0; k < 3; k++) {
            const double *q = c->turned[c->net->corners[i][k]];
            out[i].x[k] = p->at[0] + q[0];
            out[i].y[k] = p->at[1] + q[1];
            /* Each copy stands with its lowest point on the ground, lowered by `sink`. */
            out[i].z[k] = p->at[2] + (q[2] - low);
        }
}

/* Draws copies of a mesh with their lowest point on the ground. The points are rotated about the
 * origin. */
static bool solid_draw_net(const WrParams *params, const WrSolidNet *net, const WrGenerateJob *job,
                           WrRelief *out, WrError *err)
{
    WrSolidPlace *places = NULL;
    int64_t count;
    if (!wr_solid_places(params, job, &places, &count, err)) return false;
    bool good = count * net->count <= TRIANGLES_MAX;
    if (!good)
        wr_fail(err, "%lld copies of %lld triangles: must be at most %d triangles together",
                (long long)count, (long long)net->count, TRIANGLES_MAX);
    WrZTriangle *triangles = NULL;
    Copies c = { net, places, NULL };
    if (good)
        triangles =
            wr_try_alloc((size_t)(count * net->count) + 1, sizeof *triangles, "triangles", err);
    if (triangles)
        c.turned = wr_try_alloc((size_t)net->point_count + 1, sizeof *c.turned, "points", err);
    good = triangles && c.turned;
    double rise = 0.0;
    for (int64_t i = 0; good && i < count; i++) {
        double range[2] = { 0.0, 0.0 };
        turn_points(&c, &places[i], range);
        put_copy(&c, &places[i], range[0], triangles + i * net->count);
        /* `height` is the rise of the first copy at scale 1: all heights of the scene are multiplied by height / rise
           (solid_draw). */
        if (i == 0) rise = (range[1] - range[0]) / places[0].scale;
        good = !wr_progress_stopped() || wr_fail(err, "cancelled");
    }
    WrZScene scene = { .triangles = triangles, .triangle_count = count * net->count };
    good = good && solid_draw(params, &scene, count, rise, job, out, err);
    wr_free(c.turned);
    wr_free(triangles);
    wr_free(places);
    return good;
}

/* ---- meshes ---- */

const WrParam wr_params_solid_mesh[] = {
    { .name = "file",
      .label = "File",
      .help = "a mesh file: OBJ, PLY, STL, glTF, 3MF and others",
      .unit = "",
      .kind = WR_PARAM_FILE,
      .positional = true },
    WR_S_RADIUS("size", "Size", 128,
                "length of the longest side of its bounding box, before rotation"),
    WR_S_POSE,
    WR_S_HEIGHT("height of the highest place above the lowest, after rotation"),
    WR_S_PLACE,
    WR_P_END,
};

/* Centres the points at the middle of their bounding box and scales its longest side to `size`. False
 * if all are equal. */
static bool fit(const WrMesh *mesh, double size, double (*points)[3])
{
    double low[3], high[3], most = 0.0;
    for (int k = 0; k < 3; k++) {
        low[k] = high[k] = (double)mesh->points[0][k];
        for (int32_t i = 1; i < mesh->point_count; i++) {
            double x = (double)mesh->points[i][k];
            low[k] = x < low[k] ? x : low[k];
            high[k] = x > high[k] ? x : high[k];
        }
        if (high[k] - low[k] > most) most = high[k] - low[k];
    }
    double scale = size / most;
    if (!isfinite(scale)) return false;
    for (int32_t i = 0; i < mesh->point_count; i++)
        for (int k = 0; k < 3; k++)
            points[i][k] =
                scale * ((double)mesh->points[i][k] - (low[k] + 0.5 * (high[k] - low[k])));
    return true;
}

static bool solid_mesh(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                       WrError *err)
{
    const WrParams params = { wr_params_solid_mesh, values };
    const char *file = wr_param_value(&params, "file")->text;
    WrMesh mesh;
    if (!wr_mesh_read(file, &mesh, err)) return false;
    double(*points)[3] =
        wr_try_alloc((size_t)mesh.point_count, sizeof *points, "the mesh's points", err);
    bool good = points;
    if (good && !fit(&mesh, wr_param_number(&params, "size"), points))
        good = wr_fail(err, "%s: all its points coincide", file);
    const WrSolidNet net = { .points = (const double(*)[3])points,
                             .corners = mesh.corners,
                             .point_count = mesh.point_count,
                             .count = mesh.triangle_count };
    good = good && solid_draw_net(&params, &net, job, out, err);
    wr_free(points);
    wr_mesh_fini(&mesh);
    return good;
}

/* A mesh being made; owned. */
typedef struct Net {
    double (*points)[3];
    int32_t (*corners)[3];
    int64_t point_count, count;
} Net;

/* ---- reliefs ---- */

/* Heights of a picture or of a layer as a piece: a mesh with a point for each of its samples. */

static const WrParam relief_params[] = {
    { .name = "file",
      .label = "File",
      .help =
          "a picture: black is the ground, white the highest, alpha the coverage; none: a pebble",
      .unit = "",
      .kind = WR_PARAM_FILE,
      .fallback_text = "",
      .positional = true },
    WR_P_LAYER("instead of a file: a layer below, cropped to its content"),
    WR_S_RADIUS("size", "Size", 64,
                "length of the longest side of its bounding box, before rotation"),
    WR_S_RADIUS("depth", "Depth", 16,
                "height of the highest place above its ground, before rotation"),
    WR_S_POSE,
    WR_S_HEIGHT("height of the highest place above the lowest, after rotation"),
    WR_S_PLACE,
    WR_P_END,
};

static bool read_picture(const char *file, const WrGenerateJob *job, WrSheet *sheet, WrError *err)
{
    static const WrWrap clamped[] = { WR_WRAP_CLAMP, WR_WRAP_CLAMP };
    WrImage *image = wr_image_read(file, err);
    if (!image) return false;
    const int n = image->channels;
    const bool good = wr_sheet_init(sheet, image->width, image->height, clamped, err);
    if (image->note[0]) wr_generate_note(job, "%s: %s", file, image->note);
    for (size_t k = 0; good && k < (size_t)image->width * (size_t)image->height; k++) {
        const float *pixel = image->data + k * (size_t)n;
        sheet->z[k] = (double)wr_image_luma(pixel, n) * (n % 2 ? 1.0 : (double)pixel[n - 1]);
    }
    wr_image_free(image);
    return good;
}

#define PEBBLE 65 /* samples along a side */

/* The upper half of a ball: a piece to begin with. */
static bool make_pebble(WrSheet *sheet, WrError *err)
{
    static const WrWrap clamped[] = { WR_WRAP_CLAMP, WR_WRAP_CLAMP };
    if (!wr_sheet_init(sheet, PEBBLE, PEBBLE, clamped, err)) return false;
    for (int k = 0; k < PEBBLE * PEBBLE; k++) {
        const double x = (k % PEBBLE + 0.5) * 2.0 / PEBBLE - 1.0;
        const double y = (k / PEBBLE + 0.5) * 2.0 / PEBBLE - 1.0, rest = 1.0 - x * x - y * y;
        sheet->z[k] = rest > 0.0 ? sqrt(rest) : 0.0;
    }
    return true;
}

/* Cut out the part with heights. False: nothing is above 0. */
static bool cut_content(const WrSheet *whole, WrSheet *sheet, WrError *err)
{
    int low[2] = { whole->width, whole->height }, high[2] = { -1, -1 };
    for (int j = 0; j < whole->height; j++)
        for (int i = 0; i < whole->width; i++) {
            if (!(whole->z[(size_t)j * (size_t)whole->width + (size_t)i] > 0.0)) continue;
            low[0] = i < low[0] ? i : low[0];
            high[0] = i > high[0] ? i : high[0];
            low[1] = j < low[1] ? j : low[1];
            high[1] = j;
        }
    if (high[0] < 0) return wr_fail(err, "all of its heights are 0 or less");
    if (!wr_sheet_init(sheet, high[0] - low[0] + 1, high[1] - low[1] + 1, whole->wrap, err))
        return false;
    for (int j = 0; j < sheet->height; j++)
        memcpy(sheet->z + (size_t)j * (size_t)sheet->width,
               whole->z + (size_t)(low[1] + j) * (size_t)whole->width + low[0],
               (size_t)sheet->width * sizeof *sheet->z);
    return true;
}

static bool read_layer(const char *name, const WrGenerateJob *job, WrSheet *sheet, WrError *err)
{
    const WrField *heights, *cover;
    WrSheet whole = { .z = NULL }, weight = { .z = NULL };
    if (!wr_generate_layer(job, name, &heights, &cover, err)) return false;
    bool good =
        wr_sheet_read(&whole, heights, err) && (!cover || wr_sheet_read(&weight, cover, err));
    const size_t count = (size_t)whole.width * (size_t)whole.height;
    for (size_t k = 0; good && cover && k < count; k++) whole.z[k] *= weight.z[k];
    if (good) whole.wrap[0] = whole.wrap[1] = WR_WRAP_CLAMP;
    good = good && cut_content(&whole, sheet, err);
    if (!good) wr_error_prefix(err, "layer=%s: ", name);
    wr_sheet_fini(&whole);
    wr_sheet_fini(&weight);
    return good;
}

/* A sample a texel at most, and so few that all copies have room. */
static bool thin_out(WrSheet *sheet, double size, int64_t copies, const WrGenerateJob *job,
                     WrError *err)
{
    const double longest = sheet->width > sheet->height ? sheet->width : sheet->height;
    const double room = sqrt(TRIANGLES_MAX / (2.0 * (double)copies));
    const double most = fmin(fmin(ceil(job->coarse ? 0.5 * size : size), room), longest);
    if (most >= longest) return true;
    const int width = (int)rint(sheet->width * most / longest);
    const int height = (int)rint(sheet->height * most / longest);
    return wr_sheet_resize(sheet, width > 1 ? width : 1, height > 1 ? height : 1, job, err);
}

/* Points at the samples' middles, and a rim of points on the ground around them, one sample away. Sides of cells that lie on the
   ground alone are left out. */
static bool net_of(const WrSheet *sheet, double size, double depth, Net *net, WrError *err)
{
    const int across = sheet->width + 2, down = sheet->height + 2;
    const double step = size / (sheet->width > sheet->height ? sheet->width : sheet->height);
    double low, high;
    wr_sheet_range(sheet, &low, &high);
    if (!(high > 0.0)) return wr_fail(err, "all of its heights are 0 or less");
    net->points = wr_try_alloc((size_t)across * (size_t)down, sizeof *net->points, "points", err);
    net->corners = net->points ? wr_try_alloc(2 * (size_t)across * (size_t)down,
                                              sizeof *net->corners, "triangles", err)
                               : NULL;
    for (int j = 0; net->corners && j < down; j++)
        for (int i = 0; i < across; i++) {
            double *p = net->points[net->point_count++];
            const bool inside = i > 0 && j > 0 && i + 1 < across && j + 1 < down;
            const double z =
                inside ? sheet->z[(size_t)(j - 1) * (size_t)sheet->width + (size_t)(i - 1)] : 0.0;
            p[0] = (i - 0.5 * (across - 1)) * step;
            p[1] = (0.5 * (down - 1) - j) * step;
            p[2] = z > 0.0 ? z / high * depth : 0.0;
        }
    for (int j = 0; net->corners && j + 1 < down; j++)
        for (int i = 0; i + 1 < across; i++) {
            const int32_t a = j * across + i, b = a + 1, c = a + across, d = c + 1;
            const int32_t two[2][3] = { { a, c, d }, { a, d, b } };
            for (int t = 0; t < 2; t++) {
                double most = 0.0;
                for (int k = 0; k < 3; k++) most = fmax(most, net->points[two[t][k]][2]);
                if (most > 0.0) memcpy(net->corners[net->count++], two[t], sizeof two[t]);
            }
        }
    return net->corners != NULL;
}

static bool make_relief(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                        WrError *err)
{
    const WrParams params = { relief_params, values };
    const char *file = wr_param_value(&params, "file")->text;
    const char *layer = wr_param_value(&params, "layer")->text;
    const double size = wr_param_number(&params, "size");
    const bool has_file = file && *file, has_layer = layer && *layer;
    WrSheet sheet = { .z = NULL };
    WrSolidPlace *places = NULL;
    Net made = { 0 };
    int64_t copies;
    if (has_file && has_layer)
        return wr_fail(err, "solid relief: give a picture file or layer=, not both");
    bool good = (has_file    ? read_picture(file, job, &sheet, err)
                 : has_layer ? read_layer(layer, job, &sheet, err)
                             : make_pebble(&sheet, err)) &&
                wr_solid_places(&params, job, &places, &copies, err);
    wr_free(places);
    good = good && thin_out(&sheet, size, copies, job, err) &&
           net_of(&sheet, size, wr_param_number(&params, "depth"), &made, err);
    if (!good && has_file && !strstr(err->text, file)) wr_error_prefix(err, "%s: ", file);
    const WrSolidNet net = { .points = (const double(*)[3])made.points,
                             .corners = (const int32_t(*)[3])made.corners,
                             .point_count = made.point_count,
                             .count = made.count };
    good = good && solid_draw_net(&params, &net, job, out, err);
    wr_sheet_fini(&sheet);
    wr_free(made.points);
    wr_free(made.corners);
    return good;
}

/* ---- surfaces ---- */

/* The parametric surfaces as triangle meshes, seen from above. */

#define FINE 0.02  /* maximum distance in texels of the mesh from the surface */
#define ROUGH 0.25 /* that of a coarse preview */
#define CELLS_MAX 1500000
#define PROBES 48 /* positions along each axis where the second derivatives are sampled */

const WrParam wr_params_solid_surface[] = {
    { .name = "shape",
      .label = "Shape",
      .help = "a surface's name and arguments, as in \"torus R=1 r=0.35\"",
      .unit = "",
      .kind = WR_PARAM_TEXT,
      .fallback_text = "torus",
      .positional = true },
    WR_S_RADIUS("size", "Size", 128,
                "length of the longest side of its bounding box, before rotation"),
    WR_S_POSE,
    WR_S_HEIGHT("height of the highest place above the lowest, after rotation"),
    WR_S_PLACE,
    WR_P_END,
};

/* ---- parsing ---- */

static bool set_value(WrShape *shape, const char *word, size_t length, WrError *err)
{
    const char *equals = memchr(word, '=', length);
    char name[32] = "";
    size_t name_length = equals ? (size_t)(equals - word) : length;
    if (name_length < sizeof name) memcpy(name, word, name_length);
    int at = equals ? wr_surface_param_offset(shape->kind, name) : -1;
    if (at < 0)
        return wr_fail(err,
                       "solid surface: shape: \"%.*s\": must be NAME=VALUE with a number of %s",
                       (int)(length < 60 ? length : 60), word, wr_surfaces[shape->kind]->name);
    const char *from = equals + 1, *end = word + length;
    const WrSurfaceParam *p = wr_surfaces[shape->kind]->params;
    while (strcmp(p->name, name) != 0) p++;
    for (int k = 0; k < p->components; k++) {
        const char *stop = from;
        while (stop < end && *stop != ',' && *stop != ';') stop++;
        bool last = k == p->components - 1;
        if (!wr_number_parse(from, (size_t)(stop - from), &shape->value[at + k]) ||
            last != (stop == end))
            return wr_fail(err, "solid surface: shape: %s: must be %d numbers, %g..%g", name,
                           p->components, p->low, p->high);
        from = stop + (stop < end);
    }
    return true;
}

/* Index of a text parameter in "profile=0,0;1,1"; -1: not a text parameter. */
static int text_of(const WrSurfaceInfo *info, const char *word, size_t length)
{
    for (int i = 0; i < WR_SURFACE_TEXTS && info->texts[i].name; i++) {
        const size_t name = strlen(info->texts[i].name);
        if (length > name && word[name] == '=' && strncmp(word, info->texts[i].name, name) == 0)
            return i;
    }
    return -1;
}

/* Parses the words after the surface's name. text: values of its text parameters, owned by the caller. */
static bool read_words(const char *at, WrShape *shape, char *text[WR_SURFACE_TEXTS], WrError *err)
{
    const WrSurfaceInfo *info = wr_surfaces[shape->kind];
    for (at += strspn(at, " "); *at; at += strspn(at, " ")) {
        const size_t length = strcspn(at, " ");
        const int i = text_of(info, at, length);
        if (i < 0 && !set_value(shape, at, length, err)) return false;
        if (i >= 0) {
            const size_t skip = strlen(info->texts[i].name) + 1;
            wr_free(text[i]);
            text[i] = wr_alloc(length - skip + 1, 1);
            memcpy(text[i], at + skip, length - skip);
        }
        at += length;
    }
    return true;
}

/* Parses "torus R=1 r=0.35", "revolution profile=0,0;1,1". The caller frees borrowed data. */
static bool read_shape(const char *text, WrShape *shape, WrError *err)
{
    char name[32] = "", *texts[WR_SURFACE_TEXTS] = { NULL };
    text += strspn(text, " ");
    const size_t length = strcspn(text, " ");
    if (length == 0) return wr_fail(err, "solid surface: shape is empty: must be a surface's name");
    if (length < sizeof name) memcpy(name, text, length);
    const int kind = wr_surface_find(name);
    if (kind < 0)
        return wr_fail(err, "solid surface: shape: %.*s: is not a surface",
                       (int)(length < 60 ? length : 60), text);
    wr_shape_default((WrSurfaceKind)kind, shape);
    bool good = read_words(text + length, shape, texts, err) && wr_shape_check(shape, err);
    if (good && wr_surfaces[kind]->make) {
        WrSurfaceData *data = wr_surface_data_make(shape->kind, (const char *const *)texts, err);
        good = data != NULL;
        if (good) wr_shape_borrow_data(shape, data);
    }
    for (int i = 0; i < WR_SURFACE_TEXTS; i++) wr_free(texts[i]);
    return good;
}

/* ---- the net ---- */

/* Bounding box and maximum second derivatives on a grid of positions. */
typedef struct Measure {
    double low[3], high[3];
    double uu, uv, vv;
} Measure;

static double length_of(WrVec3 a)
{
    return sqrt(a.x * a.x + a.y * a.y + a.z * a.z);
}

/* A face's point at fractions of its range of u and v. */
static void part_at(const WrShape *shape, int face, double x, double y, WrSurfacePoint *out)
{
    const WrSurfaceCell c = wr_surface_cell(shape, face);
    wr_surface_at(shape, face, c.u0 + (c.u1 - c.u0) * x, c.v0 + (c.v1 - c.v0) * y, out);
}

static void measure(const WrShape *shape, Measure *m)
{
    int faces = wr_surfaces[shape->kind]->faces;
    *m = (Measure){ .low = { INFINITY, INFINITY, INFINITY },
                    .high = { -INFINITY, -INFINITY, -INFINITY } };
    for (int i = 0; i < faces * (PROBES + 1) * (PROBES + 1); i++) {
        WrSurfacePoint p;
        int u = i % (PROBES + 1), v = i / (PROBES + 1) % (PROBES + 1);
        part_at(shape, i / ((PROBES + 1) * (PROBES + 1)), (double)u / PROBES, (double)v / PROBES,
                &p);
        const double at[3] = { p.p.x, p.p.y, p.p.z };
        for (int k = 0; k < 3; k++) {
            m->low[k] = at[k] < m->low[k] ? at[k] : m->low[k];
            m->high[k] = at[k] > m->high[k] ? at[k] : m->high[k];
        }
        double uu = length_of(p.puu), uv = length_of(p.puv), vv = length_of(p.pvv);
        m->uu = uu > m->uu ? uu : m->uu;
        m->uv = uv > m->uv ? uv : m->uv;
        m->vv = vv > m->vv ? vv : m->vv;
    }
}

/* Number of cells along u and v. The error of a cell of (a, b) is (a^2 |Puu| + 2 a b |Puv| + b^2 |Pvv|)
   * / 8 at most; each term gets a third of the error, measured in surface units. So a^2 |Puu| / 8 <= error / 3 gives the
   number u = 1/a >= sqrt(Puu / (8/3 error)); the mixed term a b |Puv| / 4 <= error / 3 bounds the product u v. Both numbers
   grow by one factor, so the shape of the cells remains. */
static void choose_cells(const Measure *m, double error, int faces, int cells[2])
{
    double u = sqrt(m->uu / (8.0 / 3.0 * error)), v = sqrt(m->vv / (8.0 / 3.0 * error));
    u = u > 1.0 ? u : 1.0;
    v = v > 1.0 ? v : 1.0;
    double mixed = m->uv / (4.0 / 3.0 * error); /* lower bound of the product u v */
    if (u * v < mixed) {
        double more = sqrt(mixed / (u * v));
        u *= more;
        v *= more;
    }
    double total = u * v * faces;
    if (total > CELLS_MAX) {
        double less = sqrt(CELLS_MAX / total);
        u *= less;
        v *= less;
    }
    u = u > CELLS_MAX ? CELLS_MAX : u;
    v = v > CELLS_MAX ? CELLS_MAX : v;
    cells[0] = (int)ceil(u);
    cells[1] = (int)ceil(v);
}

/* Points row by row, (cells[0] + 1) x (cells[1] + 1) per face; faces do not share points, since the Z-buffer needs no
   connectivity. */
static void fill_face(const WrShape *shape, int face, const int cells[2], const double middle[3],
                      double scale, Net *net)
{
    int across = cells[0] + 1;
    int32_t first = (int32_t)net->point_count;
    for (int j = 0; j <= cells[1] && !wr_progress_stopped(); j++)
        for (int i = 0; i <= cells[0]; i++) {
            WrSurfacePoint p;
            part_at(shape, face, (double)i / cells[0], (double)j / cells[1], &p);
            double *out = net->points[net->point_count++];
            out[0] = scale * (p.p.x - middle[0]);
            out[1] = scale * (p.p.y - middle[1]);
            out[2] = scale * (p.p.z - middle[2]);
        }
    for (int j = 0; j < cells[1] && !wr_progress_stopped(); j++)
        for (int i = 0; i < cells[0]; i++) {
            int32_t a = first + j * across + i, b = a + 1, c = a + across, d = c + 1;
            int32_t(*two)[3] = &net->corners[net->count];
            two[0][0] = a, two[0][1] = b, two[0][2] = d;
            two[1][0] = a, two[1][1] = d, two[1][2] = c;
            net->count += 2;
        }
}

static bool make_net(const WrShape *shape, double size, double error, Net *net, WrError *err)
{
    int faces = wr_surfaces[shape->kind]->faces, cells[2];
    Measure m;
    measure(shape, &m);
    double most = 0.0, middle[3];
    for (int k = 0; k < 3; k++) {
        double side = m.high[k] - m.low[k];
        most = side > most ? side : most;
        middle[k] = m.low[k] + 0.5 * side;
    }
    double scale = size / most;
    if (!isfinite(scale)) return wr_fail(err, "solid surface: shape is a single point");
    choose_cells(&m, error / scale, faces, cells);
    size_t points = (size_t)(cells[0] + 1) * (size_t)(cells[1] + 1) * (size_t)faces;
    size_t count = 2 * (size_t)cells[0] * (size_t)cells[1] * (size_t)faces;
    net->points = wr_try_alloc(points, sizeof *net->points, "a surface's points", err);
    net->corners =
        net->points ? wr_try_alloc(count, sizeof *net->corners, "its triangles", err) : NULL;
    if (!net->corners) return false;
    for (int face = 0; face < faces; face++) fill_face(shape, face, cells, middle, scale, net);
    return !wr_progress_stopped() || wr_fail(err, "cancelled");
}

static bool solid_surface(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                          WrError *err)
{
    const WrParams params = { wr_params_solid_surface, values };
    WrShape shape;
    Net made = { 0 };
    if (!read_shape(wr_param_value(&params, "shape")->text, &shape, err)) return false;
    double error = job->coarse ? ROUGH : FINE;
    bool good = make_net(&shape, wr_param_number(&params, "size"), error, &made, err);
    const WrSolidNet net = { .points = (const double(*)[3])made.points,
                             .corners = (const int32_t(*)[3])made.corners,
                             .point_count = made.point_count,
                             .count = made.count };
    good = good && solid_draw_net(&params, &net, job, out, err);
    wr_surface_data_free((WrSurfaceData *)shape.data);
    wr_free(made.points);
    wr_free(made.corners);
    return good;
}

/* ---- letters ---- */

/* Three-dimensional letters: outlines of a font extruded as a plate, with a bevel, in any pose (Blinn
 * 1978, figure 7: the date). */

#define CHORD 0.02 /* maximum distance in texels of straight pieces from the outlines' curves */

static const char *const bevels[] = { WR_Z_BEVELS(WR_WORD) NULL };

const WrParam wr_params_solid_letters[] = {
    { .name = "text",
      .label = "Text",
      .help = "the text; \\n starts a new line, and so does \\\\n in double quotes",
      .unit = "",
      .kind = WR_PARAM_TEXT,
      .positional = true },
    WR_P_FONT(WR_FONT_SANS_BOLD), /* outlines, not bitmaps */
    WR_P_FONT_FILE,
    WR_S_RADIUS("size", "Size", 96, "font size of the letters (em)"),
    WR_S_RADIUS("depth", "Depth", 16, "thickness of the plate"),
    WR_P_TEXELS("bevel", "Bevel", 4, 32, "width of the rounded edge; at most the depth"),
    WR_P_CHOICE("profile", "Profile", WR_Z_BEVEL_ROUND, bevels, "profile of the edge"),
    WR_P_NUMBER("letters", "Letter spacing", 0, -4096, 4096, 32, "texels",
                "extra space between letters"),
    WR_P_NUMBER("lines", "Line spacing", 1, 0, 16, 2, "",
                "line spacing, as a factor of the font's"),
    WR_S_POSE,
    WR_S_HEIGHT("height of the highest place above the lowest, after rotation"),
    WR_S_PLACE,
    WR_P_END,
};

/* The outlines relative to the middle of their bounding box. NULL and an error if there are none. */
static WrZLetters *cut(const WrParams *params, WrFontOutline *outline, WrError *err)
{
    int contours = outline->first.count, points = outline->xy.count / 2;
    double low[2] = { 0.0, 0.0 }, high[2] = { 0.0, 0.0 };
    for (int i = 0; i < 2 * points; i++) {
        double x = outline->xy.data[i];
        low[i % 2] = i < 2 || x < low[i % 2] ? x : low[i % 2];
        high[i % 2] = i < 2 || x > high[i % 2] ? x : high[i % 2];
    }
    for (int i = 0; i < 2 * points; i++) outline->xy.data[i] -= 0.5 * (low[i % 2] + high[i % 2]);
    WrZContour *list = wr_alloc((size_t)contours + 1, sizeof *list);
    for (int i = 0; i < contours; i++) {
        int first = outline->first.data[i];
        int end = i + 1 < contours ? outline->first.data[i + 1] : points;
        list[i] = (WrZContour){ outline->xy.data + 2 * (size_t)first, end - first };
    }
    double depth = wr_param_number(params, "depth"), bevel = wr_param_number(params, "bevel");
    WrZLetters *letters = wr_zletters_new(list, contours, depth, bevel < depth ? bevel : depth,
                                          (WrZBevel)wr_param_whole(params, "profile"), err);
    wr_free(list);
    return letters;
}

static void report_missing(const WrGenerateJob *job, const WrFontText *text)
{
    if (text->missing_count > 0)
        wr_generate_note(job, "the font has no glyph for %d of the characters, U+%04X first",
                         (int)text->missing_count, (unsigned)text->missing[0]);
}

static bool outline_of(const WrParams *params, const WrGenerateJob *job, WrFontOutline *outline,
                       WrError *err)
{
    WrFontSetting setting = { .size = wr_param_number(params, "size"),
                              .letter_spacing = wr_param_number(params, "letters"),
                              .line_spacing = wr_param_number(params, "lines"),
                              .align = WR_FONT_CENTRE };
    const WrFontRequest ask = { .text = wr_param_value(params, "text")->text,
                                .face = wr_param_whole(params, "face") };
    const char *file = wr_param_value(params, "file")->text;
    WrFontText text = { 0 };
    char *found = NULL;
    if (!file || !*file) {
        found = wr_font_find(wr_param_whole(params, "font"), setting.size, err);
        if (!found) return false;
        file = found;
    }
    bool good = wr_font_shape(file, &ask, &text, err) &&
                wr_font_outline(&text, &setting, CHORD, outline, err);
    if (good) report_missing(job, &text);
    if (good && outline->first.count == 0)
        good = wr_fail(err, "solid letters: the text has no visible letters");
    wr_font_text_fini(&text);
    wr_free(found);
    return good;
}

static bool solid_letters(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                          WrError *err)
{
    const WrParams params = { wr_params_solid_letters, values };
    WrFontOutline outline = { 0 };
    WrZLetters *letters = NULL;
    if (outline_of(&params, job, &outline, err)) letters = cut(&params, &outline, err);
    bool good = letters && draw_copies(&params, WR_Z_LETTERS, 0.0, letters,
                                       (const double[3]){ 1, 1, 1 }, job, out, err);
    wr_zletters_free(letters);
    wr_font_outline_fini(&outline);
    return good;
}

/* ---- the generator ---- */

/* The family of solids: its rows, and the solids with closed forms. */

#define HEIGHT WR_S_HEIGHT("height of the highest place above its centre, after rotation")

static const WrParam sphere_params[] = {
    WR_S_RADIUS("radius", "Radius", 32, "radius of the sphere"),
    WR_S_POSE,
    HEIGHT,
    WR_S_PLACE,
    WR_P_END,
};

static const WrParam ellipsoid_params[] = {
    WR_S_ABOVE("radii", "Radii", 32, 256, "x,y,z", "radii along its three axes"),
    WR_S_POSE,
    HEIGHT,
    WR_S_PLACE,
    WR_P_END,
};

static const WrParam box_params[] = {
    WR_S_ABOVE("size", "Size", 64, 256, "x,y,z", "lengths of its three sides"),
    WR_S_POSE,
    HEIGHT,
    WR_S_PLACE,
    WR_P_END,
};

static const WrParam round_params[] = {
    WR_S_RADIUS("radius", "Radius", 24, "radius"),
    WR_S_RADIUS("length", "Length", 64, "length along its vertical axis"),
    WR_S_POSE,
    HEIGHT,
    WR_S_PLACE,
    WR_P_END,
};

static const WrParam capsule_params[] = {
    WR_S_RADIUS("radius", "Radius", 16, "radius of the rod and its round ends"),
    WR_S_RADIUS("length", "Length", 96, "length from end to end, along its vertical axis"),
    WR_S_POSE,
    HEIGHT,
    WR_S_PLACE,
    WR_P_END,
};

static const WrParam torus_params[] = {
    WR_S_RADIUS("radius", "Radius", 32, "radius of the ring, to the centre of the tube"),
    WR_S_RADIUS("tube", "Tube", 10, "radius of the tube, smaller than the ring's"),
    WR_S_POSE,
    HEIGHT,
    WR_S_PLACE,
    WR_P_END,
};

/* ---- drawing ---- */

static bool make_sphere(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                        WrError *err)
{
    const WrParams params = { sphere_params, values };
    double r = wr_param_number(&params, "radius");
    const double size[3] = { r, r, r };
    return draw_copies(&params, WR_Z_SPHERE, 0.0, NULL, size, job, out, err);
}

static bool make_ellipsoid(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                           WrError *err)
{
    const WrParams params = { ellipsoid_params, values };
    return draw_copies(&params, WR_Z_SPHERE, 0.0, NULL, wr_param_value(&params, "radii")->number,
                       job, out, err);
}

static bool make_box(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                     WrError *err)
{
    const WrParams params = { box_params, values };
    const double *side = wr_param_value(&params, "size")->number;
    const double size[3] = { 0.5 * side[0], 0.5 * side[1], 0.5 * side[2] };
    return draw_copies(&params, WR_Z_BOX, 0.0, NULL, size, job, out, err);
}

static bool make_round(const WrParamValue *values, WrZShape shape, const WrGenerateJob *job,
                       WrRelief *out, WrError *err)
{
    const WrParams params = { round_params, values };
    double r = wr_param_number(&params, "radius");
    const double size[3] = { r, r, 0.5 * wr_param_number(&params, "length") };
    return draw_copies(&params, shape, 0.0, NULL, size, job, out, err);
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
    return draw_copies(&params, WR_Z_CAPSULE, (0.5 * length - r) / r, NULL, size, job, out, err);
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
    return draw_copies(&params, WR_Z_TORUS, tube / r, NULL, size, job, out, err);
}

#define ROW(n, l, h, p, m) WR_GENERATOR("solid", n, l, h, "max", p, m)

const WrGenerator wr_solids[] = {
    ROW("sphere", "Sphere", "a sphere sunk into the ground: rivets, domes", sphere_params,
        make_sphere),
    ROW("ellipsoid", "Ellipsoid", "a sphere stretched along its axes", ellipsoid_params,
        make_ellipsoid),
    ROW("box", "Box", "a block with flat sides", box_params, make_box),
    ROW("cylinder", "Cylinder", "a disc or a rod", round_params, make_cylinder),
    ROW("cone", "Cone", "a cone; its tip points up", round_params, make_cone),
    ROW("torus", "Torus", "a ring; alternate=90 makes links of chains", torus_params, make_torus),
    ROW("capsule", "Capsule", "a rod with round ends", capsule_params, make_capsule),
    ROW("mesh", "Mesh file", "a mesh from a file: OBJ, PLY, STL, glTF, 3MF and others",
        wr_params_solid_mesh, solid_mesh),
    ROW("relief", "Relief", "the heights of a picture or a layer as an object to scatter",
        relief_params, make_relief),
    ROW("letters", "Letters", "letters of any font cut from a plate, in any orientation",
        wr_params_solid_letters, solid_letters),
    ROW("surface", "Surface", "any surface of `surface`, seen from above", wr_params_solid_surface,
        solid_surface),
    { .family = NULL },
};
