/* Memory estimates of commands: one table of formulas and their parameters. There is no table of times: the remaining
   time is extrapolated while a command runs, from the finished part (base/progress.h). */
#include "command/estimate.h"

#include "base/error.h"
#include "command/session_internal.h"
#include "document/blend.h"
#include "document/document.h"
#include "export/export.h"
#include "field/field.h"
#include "generate/generator.h"
#include "scene/scene.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846
#define LEAST_MB 64.0    /* smaller amounts are not reported */
#define ROWS_BYTES 2.5e6 /* of any command: rows, lists, a block of tiles */
#define PNG_BYTES 9.8e6  /* rows of a PNG that threads compress at once */
#define TABLE 4.2        /* bytes of a texel in tiles, with what lists them */

typedef struct Job {
    const WrCall *call;
    const WrDocument *document;
    double width, height;
    double texels; /* those of whole tiles */
} Job;

typedef struct Need Need;
typedef double Count(const Job *job, const Need *need); /* bytes */
struct Need {
    const char *verb, *form; /* form NULL: all forms without a row of their own */
    Count *count;            /* NULL: the amount is negligible */
    double bytes;            /* per texel of the table, unless the formula defines another unit */
    const char *unknown;     /* reason if there is no estimate */
};

/* ---- the values ---- */

static bool has(const Job *job, const char *name)
{
    for (int i = 0; i < job->call->count; i++)
        if (strcmp(job->call->specs[i].name, name) == 0) return true;
    return false;
}

/* Number k of an argument; 0 if the form has no such argument, or it has no value. */
static double number(const Job *job, const char *name, int k)
{
    const WrArg *arg = has(job, name) ? wr_call_arg(job->call, name) : NULL;
    return arg && arg->numbers ? arg->numbers[k] : 0.0;
}

static double choice(const Job *job, const char *name)
{
    return has(job, name) ? wr_call_arg(job->call, name)->choice : 0.0;
}

static double largest_two(const Job *job, const char *name)
{
    double a = number(job, name, 0), b = number(job, name, 1), c = number(job, name, 2);
    return fmax(a * b, fmax(a * c, b * c));
}

/* ---- formulas ---- */

static double texels(const Job *job, const Need *need)
{
    return need->bytes * job->texels;
}

/* One table, or the table of each layer if the command works on all layers, or on some: an upper bound. */
static double filter(const Job *job, const Need *need)
{
    const bool some = has(job, "of") && wr_call_given(job->call, "of");
    const double layers = some || choice(job, "layers") > 0.0 ? job->document->layer_count : 1.0;
    const double further =
        fmin(need->bytes, 2.0 * TABLE) * (layers - 1.0); /* only the results stay */
    return (need->bytes + further) * job->texels;
}

/* Heights that join those of the layer: by their coverage, by a blend, or within the selection. */
static double generator(const Job *job, const Need *need)
{
    const bool blends = has(job, "blend") && choice(job, "blend") != WR_BLEND_REPLACE;
    const double joining = job->document->selection ? 1.2 * TABLE : blends ? TABLE : 0.0;
    return (need->bytes + joining) * job->texels;
}

/* A copy without values shares its texels. */
static double linking(const Job *job, const Need *need)
{
    bool any = false;
    for (int i = 0; i < job->call->count; i++)
        any |= job->call->args[i].given && !job->call->specs[i].positional;
    return any ? texels(job, need) : 0.0;
}

/* A live mask needs the heights below, their measure, the terms before and the mask. */
static double masking(const Job *job, const Need *need)
{
    return (wr_call_given(job->call, "live") ? 4.0 : 1.0) * need->bytes * job->texels;
}

/* path: may be NULL */
static bool ends_with(const char *path, const char *ending)
{
    const char *dot = path ? strrchr(path, '.') : NULL;
    return dot && strcmp(dot, ending) == 0;
}

/* OpenRaster files also hold the composite. */
static double saving(const Job *job, const Need *need)
{
    return ends_with(wr_call_arg(job->call, "FILE")->text, ".ora") ? need->bytes * job->texels
                                                                   : 0.0;
}

/* bytes: per texel of the new tables. */
static double resizing(const Job *job, const Need *need)
{
    const double made = number(job, "width", 0) * number(job, "height", 0);
    return need->bytes * made * job->document->layer_count;
}

/* Area below the solid, seen from above, in texels. */
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

/* Upper bound of the number of copies of a solid. */
static double copies_of(const Job *job)
{
    const double across = number(job, "across", 0), rows = number(job, "rows", 0);
    const double step =
        number(job, "spacing", 0) > 0.0 ? number(job, "spacing", 0) : job->width / across;
    const WrArg *path = has(job, "points") ? wr_call_arg(job->call, "points") : NULL;
    if (path && path->rows > 0) { /* a smooth curve is at most half as long again as its chords */
        double length = 0.0;
        for (int i = 0; i < path->rows; i++) {
            const double *a = path->numbers + i * 2, *b = path->numbers + (i + 1) % path->rows * 2;
            length += hypot((b[0] - a[0]) * job->width, (b[1] - a[1]) * job->height);
        }
        return fmax(across, 1.5 * length / step + 2.0) * rows;
    }
    if (choice(job, "layout") == WR_LAYOUT_CHANCE) return 1.16 * job->texels / (step * step) + 1.0;
    if (choice(job, "layout") == WR_LAYOUT_HEXAGON)
        return across * fmax(rows, 1.16 * job->height / step + 2.0);
    return across * rows;
}

/* bytes: per texel covered by a copy, plus 440 for each copy. Copies that are joined are drawn twice. */
static double solid(const Job *job, const Need *need)
{
    const double copies = copies_of(job), area = shadow(job, leans(job));
    const double joined = choice(job, "join") > 0.0 ? 2.0 : 1.0;
    return joined * (need->bytes * fmin(copies * area, job->texels) + 440.0 * copies);
}

/* 180 bytes for each triangle. The size of a surface determines its subdivision. */
static double net(const Job *job, const Need *need)
{
    const double copies = copies_of(job);
    const double triangles = copies * fmin(600.0 * number(job, "size", 0), 3.3e6);
    return 180.0 * triangles + need->bytes * job->texels;
}

/* bytes: per texel under the brush. */
static double brush(const Job *job, const Need *need)
{
    const double r = number(job, "radius", 0);
    const WrArg *path = has(job, "points") ? wr_call_arg(job->call, "points") : NULL;
    const int width = path ? wr_arg_width(&job->call->specs[path - job->call->args]) : 0;
    double length = 0.0;
    for (int i = 1; path && i < path->rows; i++) {
        const double *a = path->numbers + (i - 1) * width, *b = a + width;
        length += hypot((b[0] - a[0]) * job->width, (b[1] - a[1]) * job->height);
    }
    return need->bytes * fmin(PI * r * r + 2.0 * r * length, job->texels);
}

/* bytes: per pixel. Under a tolerance the whole picture is in memory, else one band; and the derivatives of the table. */
static double picture(const Job *job, const Need *need)
{
    const double bytes = need->bytes * number(job, "size", 0) * number(job, "size", 1);
    const bool whole = job->document->scene->tolerance.kind != WR_TOLERANCE_NONE;
    return (whole ? bytes : fmin(bytes, WR_PICTURE_BYTES)) + 8.0 * job->texels;
}

/* 68 bytes for each pixel of the rasterised drawing at its default size. */
static double drawing(const Job *job, const Need *need)
{
    return need->bytes * job->texels + 68.0 * 1024.0 * 768.0;
}

/* ---- the table ---- */

#define UNKNOWN(verb, form, why)                                                                   \
    {                                                                                              \
        verb, form, .unknown = why                                                                 \
    }
#define BY_FILE "it depends on the content of the file"
#define BY_AREA "it depends on the area that it covers"

/* Upper bounds; a test counts the bytes in use and fails if one is exceeded, or is far above the peak. */
static const Need needs[] = {
    { "pattern", NULL, generator, .bytes = 4.5 },
    { "noise", NULL, generator, .bytes = 4.5 },
    { "formula", NULL, generator, .bytes = 4.5 },
    UNKNOWN("rim", NULL, BY_AREA),
    UNKNOWN("text", NULL, BY_AREA),
    { "solid", NULL, solid, .bytes = 20 },
    { "solid", "surface", net, .bytes = 1 },
    UNKNOWN("solid", "mesh", BY_FILE),
    { "terrain", "fractal", texels, .bytes = 12.2 },
    { "terrain", "hydraulic", texels, .bytes = 28 },
    { "terrain", "thermal", texels, .bytes = 24.5 },
    { "terrain", "terraces", generator, .bytes = 4.5 },
    UNKNOWN("terrain", "elevation", BY_FILE),
    UNKNOWN("picture", "photo", BY_FILE),
    UNKNOWN("picture", "normals", BY_FILE),
    UNKNOWN("picture", "paste", BY_FILE),
    UNKNOWN("picture", "svg", BY_FILE),
    UNKNOWN("picture", "path", BY_AREA),
    UNKNOWN("image", NULL, BY_FILE),
    UNKNOWN("bake", NULL, BY_FILE),
    UNKNOWN("bake-tiles", NULL, BY_FILE),
    UNKNOWN("open", NULL, BY_FILE),
    UNKNOWN("macro", NULL, BY_FILE),
    UNKNOWN("model", NULL, BY_FILE),
    { "adjust", NULL, filter, .bytes = 4.5 },
    { "adjust", "blur", filter, .bytes = 8.5 },
    { "adjust", "sharpen", filter, .bytes = 8.5 },
    { "adjust", "rotate", filter, .bytes = 8.5 },
    { "adjust", "slope-limit", filter, .bytes = 12.6 },
    { "adjust", "seamless", filter, .bytes = 20.6 },
    { "adjust", "match-edges", filter, .bytes = 12.6 },
    { "adjust", "even-light", filter, .bytes = 12.6 },
    { "adjust", "resize", resizing, .bytes = 6.5 },
    { "adjust", "crop", resizing, .bytes = 6.5 },
    { "transform", NULL, filter, .bytes = 25 },
    { "link", NULL, linking, .bytes = 25 },
    { "copy", .count = NULL },
    { "select", NULL, texels, .bytes = 8.2 },
    UNKNOWN("select", "flood", BY_AREA),
    UNKNOWN("select", "invert", BY_AREA),
    { "select", "all", .count = NULL },
    { "select", "none", .count = NULL },
    { "grid", NULL, texels, .bytes = 4.2 },
    { "ramp", NULL, texels, .bytes = 4.6 },
    UNKNOWN("flood", NULL, BY_AREA),
    UNKNOWN("shape", NULL, BY_AREA),
    { "dab", NULL, brush, .bytes = 16 },
    { "stroke", NULL, brush, .bytes = 4 },
    { "sculpt", NULL, brush, .bytes = 4 },
    { "project", NULL, texels, .bytes = 8 },
    { "layer", .count = NULL },
    { "variant", .count = NULL },
    { "layer", "mask", masking, .bytes = 4.5 },
    { "layer", "merge", texels, .bytes = 4.2 },
    { "layer", "flatten", texels, .bytes = 4.2 },
    { "table", .count = NULL },
    { "fill", .count = NULL },
    { "save", NULL, saving, .bytes = 8.4 }, /* rows at a time, as most exports */
    { "export", .count = NULL },
    { "export", "contact", texels, .bytes = 36 }, /* all maps of the cell */
    { "export", "packed", texels, .bytes = 35 },
    { "export", "lines", drawing, .bytes = 4.5 },
    { "export", "curvature", texels, .bytes = 4.5 }, /* one map in memory */
    { "export", "roughness", texels, .bytes = 4.5 },
    { "export", "direction", texels, .bytes = 4.5 },
    { "export", "displacement", texels, .bytes = 4.5 },
    { "export", "mask", texels, .bytes = 4.5 },
    { "export", "cavity", texels, .bytes = 8.8 },
    { "export", "wear", texels, .bytes = 8.8 },
    { "export", "occlusion", texels, .bytes = 18 },
    UNKNOWN("export", "horizon", "it depends on the number of directions and threads"),
    UNKNOWN("export", "solid", "it depends on the relief and on error="),
    { "export", "glb", texels, .bytes = 36 }, /* three maps in memory */
    { "maps", NULL, texels, .bytes = 32 },
    { "render", NULL, picture, .bytes = 17 },
    { "script", .count = NULL },
};

/* A filter layer needs as much memory as its operation on one table. */
static const Need *find(const char *verb, const char *form)
{
    const Need *any = NULL;
    const WrExportKind *kind = form && strcmp(verb, "export") == 0 ? wr_export_find(form) : NULL;
    if (kind && kind->solid) form = "solid";
    if (strcmp(verb, "filter") == 0) verb = "adjust";
    for (size_t i = 0; i < sizeof needs / sizeof *needs; i++) {
        const Need *need = &needs[i];
        if (strcmp(need->verb, verb) != 0) continue;
        if (!need->form) any = need;
        else if (form && strcmp(need->form, form) == 0) return need;
    }
    return any;
}

bool wr_estimate_has(const char *verb, const char *form)
{
    return find(verb, form) != NULL;
}

static bool writes_png(const WrCall *call)
{
    bool any = false;
    for (int i = 0; i < call->count; i++)
        any |= call->specs[i].type == WR_ARG_PATH && ends_with(call->args[i].text, ".png");
    return any;
}

void wr_session_estimate_call(const WrSession *session, const WrCall *call, WrEstimate *out)
{
    *out = (WrEstimate){ 0 };
    if (!call->command) return;
    WrCall *inner = wr_call_inner(call);
    if (inner) { /* a generator layer needs as much as its command */
        wr_session_estimate_call(session, inner, out);
        wr_call_free(inner);
        return;
    }
    const WrDocument *document = session->state.document;
    const WrField *field = document->layers[document->active].heights;
    Job job = { .call = call,
                .document = document,
                .width = wr_field_width(field),
                .height = wr_field_height(field) };
    const double tiles = (double)wr_field_tiles_u(field) * wr_field_tiles_v(field);
    job.texels = tiles * WR_TILE * WR_TILE; /* tables hold whole tiles */
    const Need *need = find(call->command->name, call->form_name);
    if (!need) return; /* scene, view and history commands */
    out->unknown = need->unknown;
    if (need->unknown) return;
    if (need->count) out->bytes = need->count(&job, need) + ROWS_BYTES;
    const bool output = call->command->kind == WR_CLASS_OUTPUT;
    const bool whole = output && document->layer_count > 1;
    if (output && writes_png(call)) out->bytes += PNG_BYTES;
    if (whole && !session->options.composites)
        out->bytes += 1.2 * TABLE * job.texels; /* the composite */
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
    const double mb = estimate->bytes * 1e-6;
    text[0] = '\0';
    if (estimate->unknown || mb < LEAST_MB) return;
    if (mb >= 1e3) snprintf(text, WR_ESTIMATE_TEXT, "%.3g GB", fmin(mb * 1e-3, 1e6));
    else snprintf(text, WR_ESTIMATE_TEXT, "%.0f MB", mb >= 100.0 ? 10.0 * rint(mb / 10.0) : mb);
}
