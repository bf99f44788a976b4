#include "generate/noise_generators.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/enum_rows.h"
#include "field/field.h"
#include "generate/tile_builder.h"
#include "generate/generator.h"
#include "noise/texel_grid.h"

#include <math.h>
#include <string.h>

#define DOMAINS(X)                                                                                 \
    X(DOMAIN_PLANE, "plane")                                                                       \
    X(DOMAIN_SLICE, "slice")                                                                       \
    X(DOMAIN_U, "along-u")                                                                         \
    X(DOMAIN_V, "along-v")
typedef enum Domain { DOMAINS(WR_WORD_ID) } Domain;
static const char *const domains[] = { DOMAINS(WR_WORD) NULL };
/* The kinds of noise that differ in their tiling method. */
#define WAYS(X)                                                                                    \
    X(WR_NOISE_SHEARED, "sheared")                                                                 \
    X(WR_NOISE_TORUS, "torus")                                                                     \
    X(WR_NOISE_SIMPLEX, "slice")
static const WrNoiseKind way_kinds[] = { WAYS(WR_WORD_ID) };
static const char *const ways[] = { WAYS(WR_WORD) NULL };
#define SOURCES(X)                                                                                 \
    X(WR_LATTICE_HASH, "hash")                                                                     \
    X(WR_LATTICE_LECTURE, "lecture")
static const WrLatticeSource source_kinds[] = { SOURCES(WR_WORD_ID) };
static const char *const sources[] = { SOURCES(WR_WORD) NULL };

#define NOISE_PARAMS(count)                                                                        \
    WR_P_WHOLE("cells", "Cells", count, 1, 8192, 32,                                               \
               "cells of the first octave across the table"),                                      \
        WR_P_WHOLE("rows", "Rows of cells", 0, 0, 8192, 32,                                        \
                   "cells of the first octave up the table; 0: as square as possible"),            \
        WR_P_WHOLE("octaves", "Octaves", 5, 1, WR_OCTAVES_MAX, 12,                                 \
                   "largest number of octaves; those with cells below two texels are left out"),   \
        WR_P_ABOVE("ratio", "Falloff", 2, 1, 64, 4, "",                                            \
                   "amplitude ratio of successive octaves: higher is smoother"),                   \
        WR_P_ABOVE("step", "Lacunarity", 2, 1, 64, 4, "",                                          \
                   "frequency ratio of successive octaves; rounded to whole cells"),               \
        WR_P_CHOICE("mode", "Fractal type", WR_OCTAVES_FBM, wr_octaves_words,                      \
                    "how octaves are summed"),                                                     \
        WR_P_SEED,                                                                                 \
        WR_P_SWITCH("scatter", "Random octaves", 1,                                                \
                    "on: each octave has its own random numbers and offset; off: all share them, " \
                    "literally g(s^k t)/r^k"),                                                     \
        WR_P_NUMBER("warp", "Warp", 0, -64, 64, 1, "cells",                                        \
                    "domain warping: distortion of the noise by another noise"),                   \
        WR_P_WHOLE("warp_cells", "Warp cells", 0, 0, 8192, 32,                                     \
                   "cells of the noise that warps; 0: as many as cells="),                         \
        WR_P_NUMBER("ridge_offset", "Ridge offset", 1, 0, 10, 2, "",                               \
                    "mode=ridged: height of the ridges"),                                          \
        WR_P_NUMBER("ridge_gain", "Ridge gain", 2, 0, 100, 4, "",                                  \
                    "mode=ridged: strength of fine octaves beside the ridges"),                    \
        WR_P_NUMBER("amplitude", "Height", 0.5, -WR_PARAM_HEIGHT, WR_PARAM_HEIGHT, 1,              \
                    "table units",                                                                 \
                    "amplitude of the first octave: heights are level + amplitude times noise"),   \
        WR_P_NUMBER("level", "Level", 0.5, -WR_PARAM_HEIGHT, WR_PARAM_HEIGHT, 1, "table units",    \
                    "height where the noise is 0"),                                                \
        WR_P_ORIGIN

#define SLICE                                                                                      \
    WR_P_NUMBER("slice", "Slice", 0, -1e6, 1e6, 1, "periods",                                      \
                "position of the slice through 3D noise; it repeats after 1")

static const WrParam cell_params[] = {
    NOISE_PARAMS(4),
    WR_P_CHOICE("fade", "Interpolation", WR_FADE_QUINTIC, wr_fade_words,
                "fade function between lattice points"),
    WR_P_CHOICE(
        "domain", "Domain", DOMAIN_PLANE, domains,
        "domain of the noise: the plane, a slice through 3D space, or one coordinate alone"),
    SLICE,
    WR_P_CHOICE("source", "Random numbers", 0, sources,
                "source of random numbers; the lecture's fract(sin()) is only for comparison"),
    WR_P_END
};
static const WrParam simplex_params[] = {
    NOISE_PARAMS(6),
    WR_P_CHOICE(
        "way", "Tiling", 2, ways,
        "sheared: on a sheared lattice; torus: on a torus in 4D; slice: a slice through 3D noise"),
    SLICE, WR_P_END
};
static const WrParam plane_params[] = { NOISE_PARAMS(4), WR_P_END };

/* Parameters of a row besides the octaves. */
typedef struct Described {
    WrParams params;
    WrNoiseKind kind;
    int dim, axis;
    bool cells; /* it has a fade and a source */
} Described;

static Described describe(const WrGenerator *row, const WrParamValue *values)
{
    Described d = { .params = { row->params, values },
                    .kind = (WrNoiseKind)wr_noise_find(row->name),
                    .dim = 2,
                    .cells = row->params == cell_params };
    if (d.cells) {
        Domain domain = (Domain)wr_param_whole(&d.params, "domain");
        d.dim = domain == DOMAIN_PLANE ? 2 : domain == DOMAIN_SLICE ? 3 : 1;
        d.axis = domain == DOMAIN_V;
    } else if (row->params == simplex_params) {
        d.kind = way_kinds[wr_param_whole(&d.params, "way")];
        d.dim = d.kind == WR_NOISE_SIMPLEX ? 3 : 2;
    }
    return d;
}

/* Number of cells across and up; in depth as across. Lattice counts are whole numbers, so that every octave tiles; rows = 0
   makes cells as square as that permits. */
static void count_cells(const Described *d, const char *name, int width, int height,
                        double cells[WR_NOISE_AXES])
{
    double across = wr_param_number(&d->params, name);
    if (across == 0.0) across = wr_param_number(&d->params, "cells");
    double up = wr_param_number(&d->params, "rows");
    if (up == 0.0 || strcmp(name, "cells") != 0) up = floor(across * height / width + 0.5);
    if (up < 1.0) up = 1.0;
    if (up > 8192.0) up = 8192.0;
    cells[0] = d->dim == 1 && d->axis == 1 ? up : across;
    cells[1] = up;
    cells[2] = across;
}

static WrOctaves octaves_of(const Described *d, int width, int height)
{
    const WrParams *p = &d->params;
    WrOctaves o = wr_octaves_default(d->dim);
    o.kind = d->kind;
    o.mode = (WrOctavesMode)wr_param_whole(p, "mode");
    o.count = wr_param_whole(p, "octaves");
    o.ratio = wr_param_number(p, "ratio");
    o.step = wr_param_number(p, "step");
    o.seed = wr_param_seed(p);
    o.scatter = wr_param_whole(p, "scatter") == 1;
    o.one_lattice = !o.scatter;
    o.ridge_offset = wr_param_number(p, "ridge_offset");
    o.ridge_gain = wr_param_number(p, "ridge_gain");
    count_cells(d, "cells", width, height, o.cells);
    if (d->cells) {
        o.fade = (WrFade)wr_param_whole(p, "fade");
        o.source = source_kinds[wr_param_whole(p, "source")];
    }
    return o;
}

/* Domain warp: f(x + warp w(x)) with one independent noise w per axis, in units of the first octave's cells. Two octaves are
   enough for a displacement, and both tile, so the sum does. */
static bool plan_warp(const Described *d, WrOctaves octaves, const int *texels, int width,
                      int height, WrNoiseMaker *maker, WrError *err)
{
    double warp = wr_param_number(&d->params, "warp");
    maker->warp_amount = warp / octaves.cells[0];
    if (warp == 0.0) return true;
    octaves.mode = WR_OCTAVES_FBM;
    octaves.count = 2;
    count_cells(d, "warp_cells", width, height, octaves.cells);
    for (int a = 0; a < d->dim; a++) {
        octaves.seed = wr_mix32(octaves.seed + 0x51ed270bU);
        if (!wr_octaves_plan(&octaves, texels, &maker->warp[a], err)) return false;
    }
    return true;
}

bool wr_noise_maker(const WrGenerator *row, const WrParamValue *values, int width, int height,
                    WrNoiseMaker *maker, WrError *err)
{
    Described d = describe(row, values);
    const WrParamValue *origin = wr_param_value(&d.params, "origin");
    WrNoiseMaker made = { .axis = d.axis,
                          .amplitude = wr_param_number(&d.params, "amplitude"),
                          .level = wr_param_number(&d.params, "level"),
                          .origin = { origin->number[0], origin->number[1] } };
    if (d.dim == 3) made.slice = wr_param_number(&d.params, "slice");
    if (d.dim == 3 && d.cells && wr_param_whole(&d.params, "source") == 1)
        return wr_fail(err,
                       "%s %s: source=lecture has random numbers for two coordinates at most: with "
                       "domain=slice use source=hash",
                       row->family, row->name);
    WrOctaves octaves = octaves_of(&d, width, height);
    const int texels[WR_NOISE_AXES] = { d.dim == 1 && d.axis == 1 ? height : width, height, 0 };
    if (!wr_octaves_plan(&octaves, texels, &made.plan, err) ||
        !plan_warp(&d, octaves, texels, width, height, &made, err)) {
        wr_error_prefix(err, "%s %s: ", row->family, row->name);
        return false;
    }
    *maker = made;
    return true;
}

/* N and its gradient in the noise's own coordinates. */
static double noise_at(const WrNoiseMaker *maker, const double *p, double *slope)
{
    if (maker->warp_amount == 0.0) return wr_octaves_at(&maker->plan, p, slope);
    const WrOctavesPlan *warp[WR_NOISE_AXES];
    for (int a = 0; a < maker->plan.dim; a++) warp[a] = &maker->warp[a];
    return wr_octaves_warped_at(&maker->plan, warp, maker->warp_amount, p, slope);
}

void wr_noise_maker_sample(const WrNoiseMaker *maker, double u, double v, WrNoiseReading *reading)
{
    double place[2] = { u - maker->origin[0], v - maker->origin[1] }, d[WR_NOISE_AXES] = { 0 };
    double p[WR_NOISE_AXES] = { place[0], place[1], maker->slice };
    int dim = maker->plan.dim;
    if (dim == 1) p[0] = place[maker->axis];
    double n = noise_at(maker, p, d);
    *reading = (WrNoiseReading){ .n = n, .nu = d[0], .nv = d[1] };
    if (dim == 1) {
        reading->nu = maker->axis == 0 ? d[0] : 0.0;
        reading->nv = maker->axis == 1 ? d[0] : 0.0;
    }
    reading->f = maker->level + maker->amplitude * n;
    reading->fu = maker->amplitude * reading->nu;
    reading->fv = maker->amplitude * reading->nv;
}

/* ---- tables ---- */

typedef struct Filling {
    WrNoiseMaker maker; /* at the origin's fractional texel; whole texels are rolled */
    WrOrigin across, up;
    const float *line; /* for one dimension: N at the texels along it; NULL otherwise */
} Filling;

/* Row of the unmoved table that corresponds to row j. */
static int source_row(const Filling *filling, int height, int j)
{
    int from_below = height - 1 - j - filling->up.shift;
    return height - 1 - (from_below < 0 ? from_below + height : from_below);
}

static int source_column(const Filling *filling, int width, int i)
{
    int k = i - filling->across.shift;
    return k < 0 ? k + width : k;
}

/* A rectangle of the table before the origin is moved. */
static void fill_rectangle(const Filling *filling, const WrNoiseGrid *grid, float *out)
{
    const WrNoiseMaker *m = &filling->maker;
    if (m->plan.dim == 2 && m->warp_amount == 0.0) {
        wr_octaves_grid(&m->plan, grid, out, NULL, NULL, WR_TILE);
        return;
    }
    for (int y = 0; y < grid->count_j; y++)
        for (int x = 0; x < grid->count_i; x++) {
            double u = (grid->i + x + 0.5) / grid->width;
            double v = 1.0 - (grid->j + y + 0.5) / grid->height;
            double p[WR_NOISE_AXES] = { u, v, m->slice };
            out[y * WR_TILE + x] = (float)noise_at(m, p, NULL);
        }
}

/* N over a block, in several rectangles if the roll splits it. */
static void fill_noise(const Filling *filling, const WrGenerateBlock *b, float *out)
{
    WrNoiseGrid grid = { .width = b->width, .height = b->height };
    for (int y = 0; y < b->count_j; y += grid.count_j) {
        grid.j = source_row(filling, b->height, b->j + y);
        grid.count_j = b->height - grid.j < b->count_j - y ? b->height - grid.j : b->count_j - y;
        for (int x = 0; x < b->count_i; x += grid.count_i) {
            grid.i = source_column(filling, b->width, b->i + x);
            grid.count_i = b->width - grid.i < b->count_i - x ? b->width - grid.i : b->count_i - x;
            fill_rectangle(filling, &grid, out + y * WR_TILE + x);
        }
    }
}

static void fill_line(const Filling *filling, const WrGenerateBlock *b, float *out)
{
    for (int y = 0; y < b->count_j; y++)
        for (int x = 0; x < b->count_i; x++)
            out[y * WR_TILE + x] =
                filling->line[filling->maker.axis == 0 ? source_column(filling, b->width, b->i + x)
                                                       : source_row(filling, b->height, b->j + y)];
}

static void fill(const void *ctx, const WrGenerateBlock *b, int worker, float *heights,
                 float *cover)
{
    (void)worker;
    (void)cover;
    const Filling *filling = ctx;
    if (filling->line) fill_line(filling, b, heights);
    else fill_noise(filling, b, heights);
    double level = filling->maker.level, amplitude = filling->maker.amplitude;
    for (int y = 0; y < b->count_j; y++)
        wr_octaves_scale(level, amplitude, b->count_i, heights + y * WR_TILE);
}

/* Moves every octave by a fraction of a texel. */
static void move_plan(WrOctavesPlan *plan, const double move[WR_NOISE_AXES])
{
    for (int i = 0; i < plan->used; i++)
        for (int a = 0; a < plan->dim; a++) {
            WrOctave *octave = &plan->octave[i];
            double offset = octave->offset[a] - octave->frequency[a] * move[a];
            octave->offset[a] = wr_noise_reduce(offset, octave->frequency[a]);
        }
}

static void move_maker(WrNoiseMaker *m, const WrOrigin *across, const WrOrigin *up)
{
    double u = across->rest / across->size, v = up->rest / up->size;
    if (u == 0.0 && v == 0.0) return;
    const double move[WR_NOISE_AXES] = { m->plan.dim == 1 && m->axis == 1 ? v : u, v, 0.0 };
    move_plan(&m->plan, move);
    for (int a = 0; a < m->plan.dim && m->warp_amount != 0.0; a++) move_plan(&m->warp[a], move);
}

static float *make_line(const WrNoiseMaker *m, int size, WrError *err)
{
    float *line = wr_try_alloc((size_t)size, sizeof *line, "a line of noise", err);
    for (int i = 0; line && i < size; i++) {
        double p = m->axis == 0 ? (i + 0.5) / size : 1.0 - (i + 0.5) / size;
        line[i] = (float)noise_at(m, &p, NULL);
    }
    return line;
}

static void say(const WrGenerateJob *job, const WrNoiseMaker *m, const WrParams *params)
{
    const WrOctavesPlan *plan = &m->plan;
    const char *more = plan->asked - plan->used == 1 ? " is" : " and finer are";
    if (plan->used < plan->asked)
        wr_generate_note(job,
                         "octave %d%s left out: more than one cell to two texels would alias%s",
                         plan->used + 1, more, plan->used ? "" : "; nothing is left");
    for (int a = 0; a < plan->dim && a < 2; a++) {
        const WrNoise *noise = &plan->octave[0].noise;
        int step = wr_noises[noise->kind].repeat[plan->dim - 1].step[a];
        const char *name = a == 0 ? "cells" : "rows";
        int asked = wr_param_whole(params, name), got = noise->lattice.period[a];
        if (step > 1 && asked > 0 && asked != got)
            wr_generate_note(job, "%s=%d became %d: %s noise repeats after multiples of %d", name,
                             asked, got, wr_noises[noise->kind].name, step);
    }
}

static bool make(const WrGenerator *row, const WrParamValue *values, const WrGenerateJob *job,
                 WrRelief *out, WrError *err)
{
    int width = wr_field_width(job->like), height = wr_field_height(job->like);
    Filling filling = { .line = NULL };
    WrNoiseMaker *m = &filling.maker;
    if (!wr_noise_maker(row, values, width, height, m, err)) return false;
    const WrParams params = { row->params, values };
    say(job, m, &params);
    filling.across = wr_origin(width, m->origin[0]);
    filling.up = wr_origin(height, m->origin[1]);
    move_maker(m, &filling.across, &filling.up);
    bool slow =
        m->plan.dim == 3 || m->warp_amount != 0.0 || !wr_noises[m->plan.octave[0].noise.kind].cells;
    if (job->coarse && slow && m->plan.used > 3) m->plan.used = 3;
    float *line = NULL;
    if (m->plan.dim == 1) {
        line = make_line(m, m->axis == 0 ? width : height, err);
        if (!line) return false;
    }
    filling.line = line;
    bool good = wr_generate_build(job, fill, &filling, false, 0.0, out, err);
    wr_free(line);
    return good;
}

/* Each row's function needs its own row. */
#define MAKE(index, name)                                                                          \
    static bool make_##name(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,   \
                            WrError *err)                                                          \
    {                                                                                              \
        return make(&wr_noise_rows[index], values, job, out, err);                                 \
    }
MAKE(0, perlin)
MAKE(1, gradient)
MAKE(2, value)
MAKE(3, simplex)
MAKE(4, sheared)
MAKE(5, torus)
MAKE(6, cubes)

const WrGenerator wr_noise_rows[] = {
    WR_GENERATOR("noise", "perlin", "Perlin", "slopes from a fixed set, 0 at lattice points",
                 "replace", cell_params, make_perlin),
    WR_GENERATOR("noise", "gradient", "Gradient",
                 "random values and random slopes at lattice points", "replace", cell_params,
                 make_gradient),
    WR_GENERATOR("noise", "value", "Value", "random values at lattice points", "replace",
                 cell_params, make_value),
    WR_GENERATOR("noise", "simplex", "Simplex",
                 "simplex noise on triangles or tetrahedra. 2D simplex noise cannot tile a square, "
                 "so it is a slice through 3D noise unless way= is given",
                 "replace", simplex_params, make_simplex),
    WR_GENERATOR("noise", "sheared", "Sheared simplex",
                 "simplex noise on triangles that fit the square", "replace", plane_params,
                 make_sheared),
    WR_GENERATOR("noise", "torus", "Torus", "4D simplex noise on a torus", "replace", plane_params,
                 make_torus),
    WR_GENERATOR("noise", "cubes", "Torus of cubes", "4D Perlin noise on a torus", "replace",
                 plane_params, make_cubes),
    { .family = NULL },
};
