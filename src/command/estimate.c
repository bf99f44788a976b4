/* What commands cost: one table of prices, and the few ways in which their work is counted. */
#include "command/estimate.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/pool.h"
#include "command/generate.h"
#include "command/inner.h"
#include "document/document.h"
#include "field/field.h"
#include "scene/scene.h"

#include <math.h>
#include <string.h>

/* The prices are nanoseconds of one thread of an AVX2 server processor at about 3 GHz; other machines are this
   many times slower. */
#define MACHINE 1.0
#define PI 3.14159265358979323846
#define JOIN_NS 10.0      /* a texel that a generator made joins its layer */
#define TILES_BYTES 0.5e6 /* of any command that makes a table, however small */

typedef struct Job {
    const WrCall *call;
    const WrDocument *document;
    double width, height, texels;
} Job;

typedef struct Price Price;
typedef void Count(const Job *job, const Price *price, WrEstimate *out);
struct Price {
    const char *verb, *form; /* form NULL: of all that have no row of their own */
    Count *count;            /* adds nanoseconds to `seconds`, and bytes; NULL: it takes no time */
    double ns;               /* of one piece of work: a texel unless the count says otherwise */
    double bytes;            /* a texel of the table */
    double more, each, turned, hidden; /* further prices, as the count says */
    const char *unknown;               /* nothing is known, and why */
};

/* ---- the values ---- */

static bool has(const Job *job, const char *name)
{
    for (int i = 0; i < job->call->count; i++)
        if (strcmp(job->call->specs[i].name, name) == 0) return true;
    return false;
}

/* Number k of an argument; 0 if the form has none of that name, or no value. */
static double number(const Job *job, const char *name, int k)
{
    const WrArg *arg = has(job, name) ? wr_call_arg(job->call, name) : NULL;
    return arg && arg->numbers ? arg->numbers[k] : 0.0;
}

static double choice(const Job *job, const char *name)
{
    return has(job, name) ? wr_call_arg(job->call, name)->choice : 0.0;
}

/* Is that choice this word? */
static bool is_word(const Job *job, const char *name, const char *word)
{
    for (int i = 0; i < job->call->count; i++) {
        const WrArgSpec *spec = &job->call->specs[i];
        if (strcmp(spec->name, name) == 0)
            return strcmp(wr_arg_word(spec, job->call->args[i].choice), word) == 0;
    }
    return false;
}

static double largest_two(const Job *job, const char *name)
{
    double a = number(job, name, 0), b = number(job, name, 1), c = number(job, name, 2);
    return fmax(a * b, fmax(a * c, b * c));
}

/* ---- how work is counted ---- */

static void add(WrEstimate *out, double ns, double bytes)
{
    out->seconds += ns;
    out->bytes += bytes;
}

static void texels(const Job *job, const Price *p, WrEstimate *out)
{
    add(out, p->ns * job->texels, p->bytes * job->texels);
}

/* more: of a ridge, which asks at every texel how far away the edge is, not only near it. */
static void edge(const Job *job, const Price *p, WrEstimate *out)
{
    const bool ridge = is_word(job, "kind", "ridge");
    add(out, (ridge ? p->more : p->ns) * job->texels, p->bytes * job->texels);
}

/* ns: an octave; more: one of those that are not made row by row. */
static void octaves(const Job *job, const Price *p, WrEstimate *out)
{
    double seen = log2(fmax(2.0, job->width / 2.0 / fmax(1.0, number(job, "cells", 0))));
    double fit = 1.0 + seen / log2(number(job, "step", 0));
    double count = fmin(number(job, "octaves", 0), fit), warp = number(job, "warp", 0);
    bool slow = warp != 0.0 || choice(job, "domain") != 0.0;
    add(out, job->texels * (slow ? p->more * (count + (warp != 0.0 ? 2.0 : 0.0)) : p->ns * count),
        p->bytes * job->texels);
}

/* ns: a term at a texel. */
static void terms(const Job *job, const Price *p, WrEstimate *out)
{
    const char *name = has(job, "terms") ? "terms" : "c";
    add(out, p->ns * job->texels * wr_call_arg(job->call, name)->rows, p->bytes * job->texels);
}

/* each: one of them, as long as they are by default. */
static void scratches(const Job *job, const Price *p, WrEstimate *out)
{
    double length = fmin(number(job, "length", 0), 4.0 * fmin(job->width, job->height));
    add(out, p->each * number(job, "count", 0) * (0.1 + length / 180.0), p->bytes * job->texels);
}

/* ns: a drop; more: what a wider one takes besides, by its area. */
static void rain(const Job *job, const Price *p, WrEstimate *out)
{
    double r = number(job, "radius", 0), life = fmin(1.0, number(job, "life", 0) / 128.0);
    add(out, job->texels * number(job, "rain", 0) * life * p->ns * (1.0 + p->more * r * r),
        p->bytes * job->texels);
}

static void rounds(const Job *job, const Price *p, WrEstimate *out)
{
    add(out, p->ns * job->texels * (1.0 + number(job, "rounds", 0)), p->bytes * job->texels);
}

/* more: what a texel of its radius or width adds, as a part of ns, up to that of wide blurs. */
static void filter(const Job *job, const Price *p, WrEstimate *out)
{
    double wide =
        has(job, "sigma") ? fmin(number(job, "sigma", 0), 24.0) : number(job, "radius", 0);
    double layers = choice(job, "layers") > 0.0 ? job->document->layer_count : 1.0;
    add(out, p->ns * (1.0 + p->more * wide) * job->texels * layers,
        p->bytes * job->texels * layers);
}

/* more: an octave of noise that is not made row by row. */
static void noisy(const Job *job, const Price *p, WrEstimate *out)
{
    const bool sheared = is_word(job, "kind", "sheared");
    const double layers = choice(job, "layers") > 0.0 ? job->document->layer_count : 1.0;
    const double ns = p->ns + (sheared ? p->more * number(job, "octaves", 0) : 0.0);
    add(out, ns * job->texels * layers, p->bytes * job->texels * layers);
}

static void resizing(const Job *job, const Price *p, WrEstimate *out)
{
    double made = number(job, "width", 0) * number(job, "height", 0);
    double layers = job->document->layer_count;
    add(out, p->ns * fmax(made, job->texels) * layers, p->bytes * made * layers);
}

/* What lies under it, seen from above, texels. */
static double shadow(const Job *job, bool turned)
{
    double r = number(job, "radius", 0), tall = turned ? number(job, "length", 0) : 0.0;
    double size = number(job, "size", 0);
    if (has(job, "tube")) return 4.0 * PI * r * number(job, "tube", 0);
    if (has(job, "radii")) return PI * largest_two(job, "radii");
    if (has(job, "text"))
        return 0.5 * size * size * (double)strlen(wr_call_arg(job->call, "text")->text);
    if (has(job, "size")) return largest_two(job, "size");
    return PI * r * r + 2.0 * r * tall;
}

static bool leans(const Job *job)
{
    return number(job, "rotate", 0) != 0.0 || number(job, "rotate", 1) != 0.0 ||
           number(job, "tilt", 0) != 0.0 || number(job, "alternate", 0) != 0.0;
}

/* Texels that are drawn: nearly all of loose copies; of close ones those that are seen, and few more. */
static double drawn(double texels, double covered)
{
    double times = covered / texels, left = covered / (1.0 + times * times / 10.0);
    return times > 1.0 ? fmax(texels, left) : left;
}

/* ns: a texel that is drawn; turned: so many times that if it leans. What others hide is left out by whole parts of
   tiles: a copy costs `each`, a texel of it `hidden` or, of large ones, its rim `more` times ns. */
static void solid(const Job *job, const Price *p, WrEstimate *out)
{
    bool turned = leans(job);
    double copies = number(job, "across", 0) * number(job, "rows", 0), area = shadow(job, turned);
    double rate = !turned ? p->hidden : p->ns * (has(job, "tube") ? 1.0 : 0.05);
    double hidden = fmin(rate * area, p->ns * p->more * 128.0 * sqrt(PI * area));
    add(out,
        (turned ? p->turned : 1.0) * (p->ns * drawn(job->texels, copies * area) + copies * hidden) +
            p->each * copies,
        p->bytes * fmin(copies * area, job->texels) + 440.0 * copies);
}

/* ns: a texel of those that stand upright, each: one of them besides; turned: of those that lean, whose rims are what
   takes long, a texel of a letter's size. Letters hide less than solids without holes do. */
static void letters(const Job *job, const Price *p, WrEstimate *out)
{
    const double copies = number(job, "across", 0) * number(job, "rows", 0);
    const double area = shadow(job, false), close = copies * area / job->texels;
    const double count = (double)strlen(wr_call_arg(job->call, "text")->text);
    const double one = leans(job) ? p->turned * number(job, "size", 0) * count : p->ns * area;
    add(out, copies * (one + p->each) / (1.0 + close / (leans(job) ? 5.0 : 20.0)),
        p->bytes * fmin(copies * area, job->texels) + 440.0 * copies);
}

/* each: a triangle. How finely a surface is cut goes by its size. */
static void net(const Job *job, const Price *p, WrEstimate *out)
{
    double copies = number(job, "across", 0) * number(job, "rows", 0);
    double triangles = copies * fmin(600.0 * number(job, "size", 0), 3.3e6);
    add(out, p->each * triangles, 140.0 * triangles + p->bytes * job->texels);
}

/* ns: a texel under the brush. */
static void brush(const Job *job, const Price *p, WrEstimate *out)
{
    double r = number(job, "radius", 0), length = 0.0;
    const WrArg *path = has(job, "points") ? wr_call_arg(job->call, "points") : NULL;
    for (int i = 1; path && i < path->rows; i++) {
        const double *a = path->numbers + (i - 1) * 6, *b = a + 6;
        length += hypot((b[0] - a[0]) * job->width, (b[1] - a[1]) * job->height);
    }
    double area = PI * r * r + 2.0 * r * length;
    add(out, p->ns * area, p->bytes * fmin(area, job->texels));
}

static bool is_many(WrAntialias aa)
{
    return aa == WR_AA_SUPERSAMPLE || aa == WR_AA_ADAPTIVE;
}

/* ns: a sample; bytes: a pixel, of a picture that is held whole. */
static void picture(const Job *job, const Price *p, WrEstimate *out)
{
    const WrScene *scene = job->document->scene;
    double pixels = number(job, "size", 0) * number(job, "size", 1);
    double k = is_many(scene->dials.aa) ? scene->dials.samples : 1.0;
    const bool whole = scene->tolerance.kind != WR_TOLERANCE_NONE;
    const double bytes = p->bytes * pixels;
    const double frames = wr_call_given(job->call, "frames") ? number(job, "frames", 0) : 1.0;
    add(out, p->ns * pixels * k * k * frames, whole ? bytes : fmin(bytes, WR_PICTURE_BYTES));
}

static void all_layers(const Job *job, const Price *p, WrEstimate *out)
{
    double layers = job->document->layer_count;
    add(out, p->ns * job->texels * layers, p->bytes * job->texels * layers);
}

/* more: a texel of a layer in an OpenRaster file. Nothing here counts what the library of files takes to start, once:
   about 0.6 s and 110 MB. */
static void saving(const Job *job, const Price *p, WrEstimate *out)
{
    const char *name = has(job, "FILE") ? wr_call_arg(job->call, "FILE")->text : NULL;
    char ending[16];
    bool archive = name && strcmp(wr_path_ending(name, ending), "ora") == 0;
    double layers = job->document->layer_count;
    add(out, (archive ? p->more : p->ns) * job->texels * layers, p->bytes * job->texels);
}

/* more: a pixel of the drawing, taken as large as it is by default. */
static void drawing(const Job *job, const Price *p, WrEstimate *out)
{
    const double pixels = 1024.0 * 768.0;
    add(out, p->ns * job->texels + p->more * pixels, p->bytes * job->texels + 68.0 * pixels);
}

/* ---- the prices ---- */

#define PATTERN(name, price)                                                                       \
    {                                                                                              \
        "pattern", name, texels, .ns = (price), .bytes = 8.2                                       \
    }
#define NOISE(name, price, slow)                                                                   \
    {                                                                                              \
        "noise", name, octaves, .ns = (price), .more = (slow), .bytes = 8.2                        \
    }
#define SOLID(name, price, rim, lean, below, one)                                                  \
    {                                                                                              \
        "solid", name, solid, .ns = (price), .more = (rim), .turned = (lean), .hidden = (below),   \
                              .each = (one), .bytes = 14                                           \
    }
#define ADJUST(name, price, wider)                                                                 \
    {                                                                                              \
        "adjust", name, filter, .ns = (price), .more = (wider), .bytes = 9                         \
    }
#define BODY(form)                                                                                 \
    {                                                                                              \
        "export", form, .unknown = "it goes by the relief, and by its error="                      \
    }
#define UNKNOWN(verb, form)                                                                        \
    {                                                                                              \
        verb, form, .unknown = "it goes by what is in the file"                                    \
    }

static const Price prices[] = {
    PATTERN("bricks", 530),
    PATTERN("tiles", 45),
    PATTERN("hexagons", 215),
    PATTERN("planks", 320),
    PATTERN("shingles", 325),
    PATTERN("scales", 3300),
    PATTERN("weave", 950),
    PATTERN("rope", 780),
    PATTERN("chain", 275),
    PATTERN("grid", 15),
    PATTERN("checks", 18),
    PATTERN("stripes", 12),
    PATTERN("waves", 250),
    PATTERN("knurl", 170),
    PATTERN("dots", 380),
    PATTERN("voronoi", 115),
    PATTERN("cracks", 770),
    { "pattern", "scratches", scratches, .each = 1e6, .bytes = 8.2 },
    NOISE("perlin", 1.4, 110),
    NOISE("gradient", 1.4, 110),
    NOISE("value", 1.4, 110),
    NOISE("simplex", 160, 160),
    NOISE("sheared", 8, 110),
    NOISE("torus", 280, 280),
    NOISE("cubes", 450, 450),
    { "formula", "fourier", terms, .ns = 100, .bytes = 8.2 },
    { "formula", "poly", terms, .ns = 5.5, .bytes = 8.2 },
    { "rim", NULL, edge, .ns = 150, .more = 650, .bytes = 20 },
    { "text", NULL, texels, .ns = 6, .bytes = 6 },
    SOLID("sphere", 50, 0.05, 1, 0.25, 2e3),
    SOLID("ellipsoid", 50, 0.05, 1, 2.5, 2e3),
    SOLID("box", 40, 1, 3.5, 0.1, 1.5e3),
    SOLID("cylinder", 100, 1, 4, 0.25, 2e3),
    SOLID("cone", 300, 1, 2, 30, 2e3),
    SOLID("torus", 120, 1, 5, 1.6, 2e3),
    SOLID("capsule", 110, 1, 4, 0.1, 2e3),
    { "solid", "letters", letters, .ns = 250, .turned = 4.4e5, .each = 2.5e6, .bytes = 14 },
    { "solid", "surface", net, .each = 450, .bytes = 1 },
    UNKNOWN("solid", "mesh"),
    { "terrain", "fractal", octaves, .ns = 20, .more = 90, .bytes = 12 },
    { "terrain", "hydraulic", rain, .ns = 3700, .more = 0.01, .bytes = 29 },
    { "terrain", "thermal", rounds, .ns = 57, .bytes = 25 },
    { "terrain", "terraces", texels, .ns = 80, .bytes = 12 },
    UNKNOWN("terrain", "elevation"),
    UNKNOWN("picture", "photo"),
    UNKNOWN("picture", "normals"),
    UNKNOWN("picture", "paste"),
    UNKNOWN("image", NULL),
    UNKNOWN("open", NULL),
    ADJUST(NULL, 11, 0),
    ADJUST("levels", 60, 0),
    ADJUST("curves", 30, 0),
    ADJUST("blur", 11, 0.12),
    ADJUST("sharpen", 11, 0.12),
    ADJUST("median", 40, 0.22),
    ADJUST("dilate", 10, 0.035),
    ADJUST("erode", 10, 0.035),
    { "adjust", "noise", noisy, .ns = 12, .more = 8, .bytes = 9 },
    ADJUST("warp", 30, 0),
    { "adjust", "slope-limit", filter, .ns = 25, .bytes = 14 },
    { "adjust", "resize", resizing, .ns = 10, .bytes = 6.5 },
    { "adjust", "crop", resizing, .ns = 3, .bytes = 8 },
    { "transform", NULL, texels, .ns = 400, .bytes = 16 },
    { "copy", NULL, texels, .ns = 60, .bytes = 8 },
    { "select", NULL, texels, .ns = 6, .bytes = 4 },
    { "select", "slope", texels, .ns = 54, .bytes = 6 },
    { "grid", NULL, texels, .ns = 2.5, .bytes = 4 },
    { "ramp", NULL, texels, .ns = 12, .bytes = 4 },
    { "flood", NULL, texels, .ns = 5, .bytes = 4 },
    { "shape", NULL, texels, .ns = 6, .bytes = 4 },
    { "dab", NULL, brush, .ns = 5, .bytes = 5 },
    { "stroke", NULL, brush, .ns = 10, .bytes = 8 },
    { "layer", NULL, texels, .ns = 1, .bytes = 0 },
    { "layer", "merge", all_layers, .ns = 10, .bytes = 4 },
    { "layer", "flatten", all_layers, .ns = 10, .bytes = 4 },
    { "table", NULL, .count = NULL },
    { "fill", NULL, .count = NULL },
    { "save", NULL, saving, .ns = 165, .bytes = 6, .more = 840 },
    { "export", NULL, texels, .ns = 400, .bytes = 6 },
    { "export", "height", texels, .ns = 150, .bytes = 6 },
    { "export", "contact", texels, .ns = 6000, .bytes = 30 }, /* all maps of the cell */
    { "export", "packed", texels, .ns = 1200, .bytes = 24 },
    { "export", "lines", drawing, .ns = 210, .bytes = 4.5, .more = 600 },
    { "export", "profile", drawing, .ns = 0, .bytes = 0, .more = 90 },
    BODY("stl"),
    BODY("ply"),
    BODY("obj"),
    { "maps", NULL, texels, .ns = 1500, .bytes = 24 }, /* four of them, as most sets have */
    { "render", NULL, picture, .ns = 33, .bytes = 17 },
    { "script", NULL, .count = NULL },
};

/* A filter layer costs what the operation costs over one table. */
static const Price *find(const char *verb, const char *form)
{
    const Price *any = NULL;
    if (strcmp(verb, "filter") == 0) verb = "adjust";
    for (size_t i = 0; i < sizeof prices / sizeof *prices; i++) {
        const Price *p = &prices[i];
        if (strcmp(p->verb, verb) != 0) continue;
        if (!p->form) any = p;
        else if (form && strcmp(p->form, form) == 0) return p;
    }
    return any;
}

bool wr_estimate_has(const char *verb, const char *form)
{
    return find(verb, form) != NULL;
}

void wr_session_estimate_call(const WrSession *session, const WrCall *call, WrEstimate *out)
{
    *out = (WrEstimate){ 0 };
    if (!call->command) return;
    const WrDocument *document = session->state.document;
    const WrField *field = document->layers[document->active].heights;
    Job job = { .call = call,
                .document = document,
                .width = wr_field_width(field),
                .height = wr_field_height(field) };
    job.texels = job.width * job.height;
    const Price *price = find(call->command->name, call->form_name);
    if (!price) return; /* scenes, views and steps through the history: at once */
    out->unknown = price->unknown;
    if (price->unknown || !price->count) return;
    price->count(&job, price, out);
    if (price->bytes > 0.0) out->bytes += TILES_BYTES;
    if (wr_call_generator(call)) out->seconds += JOIN_NS * job.texels;
    out->seconds *= 1e-9 * MACHINE / wr_pool_threads(session->options.pool);
}

bool wr_session_estimate(const WrSession *session, const char *line, WrEstimate *out, WrError *err)
{
    WrCall *call;
    if (!wr_call_parse(line, false, &call, err)) return false;
    wr_session_estimate_call(session, call, out);
    wr_call_free(call);
    return true;
}

void wr_estimate_print(const WrEstimate *estimate, char text[WR_ESTIMATE_TEXT])
{
    double s = estimate->seconds, mb = estimate->bytes * 1e-6;
    char memory[20] = "", time[20];
    text[0] = '\0';
    if (estimate->unknown || (s < 0.5 && mb < 64.0)) return;
    if (s < 9.95) snprintf(time, sizeof time, "%.1f s", s);
    else if (s < 100.0) snprintf(time, sizeof time, "%.0f s", s);
    else if (s < 5940.0) snprintf(time, sizeof time, "%.0f min", s / 60.0);
    else snprintf(time, sizeof time, "%.3g h", fmin(s / 3600.0, 1e6));
    if (mb >= 1e3) snprintf(memory, sizeof memory, ", %.3g GB", fmin(mb * 1e-3, 1e6));
    else if (mb >= 1.0)
        snprintf(memory, sizeof memory, ", %.0f MB", mb >= 100.0 ? 10.0 * rint(mb / 10.0) : mb);
    snprintf(text, WR_ESTIMATE_TEXT, "about %s%s", time, memory);
}
