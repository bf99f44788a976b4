/* Memory estimates of commands: one table of formulas and their parameters. There is no table of times: the remaining
   time is extrapolated while a command runs, from the finished part (base/progress.h). */
#include "command/estimate.h"

#include "base/error.h"
#include "command/session_internal.h"
#include "document/document.h"
#include "field/field.h"
#include "scene/scene.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846
#define LEAST_MB 64.0     /* smaller amounts are not reported */
#define TILES_BYTES 0.5e6 /* of any command that creates a table, however small */

typedef struct Job {
    const WrCall *call;
    const WrDocument *document;
    double width, height, texels;
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

/* One table, or the table of each layer if the command works on all layers. */
static double filter(const Job *job, const Need *need)
{
    const double layers = choice(job, "layers") > 0.0 ? job->document->layer_count : 1.0;
    return need->bytes * job->texels * layers;
}

static double all_layers(const Job *job, const Need *need)
{
    return need->bytes * job->texels * job->document->layer_count;
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

/* bytes: per texel covered by a copy, plus 440 for each copy. */
static double solid(const Job *job, const Need *need)
{
    const double copies = number(job, "across", 0) * number(job, "rows", 0);
    const double area = shadow(job, leans(job));
    return need->bytes * fmin(copies * area, job->texels) + 440.0 * copies;
}

/* 140 bytes for each triangle. The size of a surface determines its subdivision. */
static double net(const Job *job, const Need *need)
{
    const double copies = number(job, "across", 0) * number(job, "rows", 0);
    const double triangles = copies * fmin(600.0 * number(job, "size", 0), 3.3e6);
    return 140.0 * triangles + need->bytes * job->texels;
}

/* bytes: per texel under the brush. */
static double brush(const Job *job, const Need *need)
{
    const double r = number(job, "radius", 0);
    const WrArg *path = has(job, "points") ? wr_call_arg(job->call, "points") : NULL;
    double length = 0.0;
    for (int i = 1; path && i < path->rows; i++) {
        const double *a = path->numbers + (i - 1) * 6, *b = a + 6;
        length += hypot((b[0] - a[0]) * job->width, (b[1] - a[1]) * job->height);
    }
    return need->bytes * fmin(PI * r * r + 2.0 * r * length, job->texels);
}

/* bytes: per pixel. Under a tolerance the whole picture is in memory, else one band. */
static double picture(const Job *job, const Need *need)
{
    const double bytes = need->bytes * number(job, "size", 0) * number(job, "size", 1);
    const bool whole = job->document->scene->tolerance.kind != WR_TOLERANCE_NONE;
    return whole ? bytes : fmin(bytes, WR_PICTURE_BYTES);
}

/* 68 bytes for each pixel of the rasterised drawing at its default size. */
static double drawing(const Job *job, const Need *need)
{
    return need->bytes * job->texels + 68.0 * 1024.0 * 768.0;
}

/* ---- the table ---- */

#define BODY(form)                                                                                 \
    {                                                                                              \
        "export", form, .unknown = "it goes by the relief, and by its error="                      \
    }
#define UNKNOWN(verb, form)                                                                        \
    {                                                                                              \
        verb, form, .unknown = "it goes by what is in the file"                                    \
    }

static const Need needs[] = {
    { "pattern", NULL, texels, .bytes = 8.2 },
    { "noise", NULL, texels, .bytes = 8.2 },
    { "formula", NULL, texels, .bytes = 8.2 },
    { "rim", NULL, texels, .bytes = 20 },
    { "text", NULL, texels, .bytes = 6 },
    { "solid", NULL, solid, .bytes = 14 },
    { "solid", "surface", net, .bytes = 1 },
    UNKNOWN("solid", "mesh"),
    { "terrain", "fractal", texels, .bytes = 12 },
    { "terrain", "hydraulic", texels, .bytes = 29 },
    { "terrain", "thermal", texels, .bytes = 25 },
    { "terrain", "terraces", texels, .bytes = 12 },
    UNKNOWN("terrain", "elevation"),
    UNKNOWN("picture", "photo"),
    UNKNOWN("picture", "normals"),
    UNKNOWN("picture", "paste"),
    UNKNOWN("image", NULL),
    UNKNOWN("open", NULL),
    { "adjust", NULL, filter, .bytes = 9 },
    { "adjust", "slope-limit", filter, .bytes = 14 },
    { "adjust", "resize", resizing, .bytes = 6.5 },
    { "adjust", "crop", resizing, .bytes = 8 },
    { "transform", NULL, texels, .bytes = 16 },
    { "copy", NULL, texels, .bytes = 8 },
    { "select", NULL, texels, .bytes = 4 },
    { "select", "slope", texels, .bytes = 6 },
    { "grid", NULL, texels, .bytes = 4 },
    { "ramp", NULL, texels, .bytes = 4 },
    { "flood", NULL, texels, .bytes = 4 },
    { "shape", NULL, texels, .bytes = 4 },
    { "dab", NULL, brush, .bytes = 5 },
    { "stroke", NULL, brush, .bytes = 8 },
    { "layer", .count = NULL },
    { "layer", "merge", all_layers, .bytes = 4 },
    { "layer", "flatten", all_layers, .bytes = 4 },
    { "table", .count = NULL },
    { "fill", .count = NULL },
    { "save", NULL, texels, .bytes = 6 },
    { "export", NULL, texels, .bytes = 6 },
    { "export", "contact", texels, .bytes = 30 }, /* all maps of the cell */
    { "export", "packed", texels, .bytes = 24 },
    { "export", "lines", drawing, .bytes = 4.5 },
    { "export", "profile", drawing, .bytes = 0 },
    BODY("stl"),
    BODY("ply"),
    BODY("obj"),
    { "export", "glb", texels, .bytes = 30 }, /* three maps in memory */
    { "maps", NULL, texels, .bytes = 24 },    /* four maps, as in most sets */
    { "render", NULL, picture, .bytes = 17 },
    { "script", .count = NULL },
};

/* A filter layer needs as much memory as its operation on one table. */
static const Need *find(const char *verb, const char *form)
{
    const Need *any = NULL;
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
    const Need *need = find(call->command->name, call->form_name);
    if (!need) return; /* scene, view and history commands */
    out->unknown = need->unknown;
    if (need->unknown || !need->count) return;
    out->bytes = need->count(&job, need) + TILES_BYTES;
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
