/* The parametric surfaces as triangle meshes, seen from above. */
#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "generate/tile_builder.h"
#include "generate/solid.h"
#include "surface/data.h"
#include "surface/surface.h"

#include <string.h>

#define FINE 0.02  /* maximum distance in texels of the mesh from the surface */
#define ROUGH 0.25 /* that of a coarse preview */
#define CELLS_MAX 1500000
#define PROBES 48 /* positions along each axis where the second derivatives are sampled */

const WrParam wr_params_solid_surface[] = {
    { .name = "shape",
      .label = "Shape",
      .help = "a surface's name and numbers, as in \"torus R=1 r=0.35\"",
      .unit = "",
      .kind = WR_PARAM_TEXT,
      .fallback_text = "torus",
      .positional = true },
    WR_S_RADIUS("size", "Size", 128, "of the longest side of its box, before it is turned"),
    WR_S_POSE,
    WR_S_HEIGHT("of its highest place over its lowest, as it is turned"),
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
        return wr_fail(err, "solid surface: shape: %.*s: is no surface",
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
 * / 8 at most; each term gets a third of the error, measured in surface units. */
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

typedef struct Net {
    double (*points)[3];
    int32_t (*corners)[3];
    int64_t point_count, count;
} Net;

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

bool wr_solid_surface(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
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
    good = good && wr_solid_draw_net(&params, &net, job, out, err);
    wr_surface_data_free((WrSurfaceData *)shape.data);
    wr_free(made.points);
    wr_free(made.corners);
    return good;
}
