/* The reference scene, and the time of its pictures. */
#include "base/enum_rows.h"
#include "base/error.h"
#include "base/exactmath.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/text.h"
#include "bench/bench.h"
#include "cli/cli.h"
#include "field/field.h"
#include "image/image.h"
#include "render/frame/frame.h"
#include "scene/dials.h"
#include "scene/scene.h"
#include "shade/bump_mode.h"
#include "surface/surface.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ROWS_MAX 128
#define COLOUR_SIZE 512

/* ---- the scene ---- */

WR_ROWS(wr_bench_modes);
const char *const wr_bench_modes[WR_BENCH_MODE_COUNT] = {
    [WR_ROW(WR_BENCH_PHONG)] = "phong",         [WR_ROW(WR_BENCH_TEXTURE)] = "texture",
    [WR_ROW(WR_BENCH_BUMP)] = "bump",           [WR_ROW(WR_BENCH_BUMP_TEXTURE)] = "bump+texture",
    [WR_ROW(WR_BENCH_MIP)] = "bump_mip",        [WR_ROW(WR_BENCH_SS16)] = "ss16",
    [WR_ROW(WR_BENCH_ADAPTIVE)] = "adaptive16",
};
WR_ROWS_END(wr_bench_modes, WR_BENCH_MODE_COUNT);

static double wave(double turns)
{
    double s, c;
    wr_sincos_turns(turns, &s, &c);
    return s;
}

static double grain(uint32_t seed)
{
    return (wr_mix32(seed) >> 8) * 0x1p-24 - 0.5;
}

WrField *wr_bench_field(int size, WrError *err)
{
    WrField *field = wr_field_new(size, size, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, err);
    if (!field) return NULL;
    for (int ty = 0; ty < wr_field_tiles_v(field); ty++)
        for (int tx = 0; tx < wr_field_tiles_u(field); tx++) {
            float *tile = wr_field_tile_write(field, tx, ty);
            for (int k = 0; k < WR_TILE * WR_TILE; k++) {
                int i = tx * WR_TILE + k % WR_TILE, j = ty * WR_TILE + k / WR_TILE;
                double u = (double)i / size, v = (double)j / size;
                if (i >= size || j >= size) continue;
                double lumps = 0.010 * wave(6 * u + 0.2069 * wave(3 * v)) * wave(5 * v);
                double scratches = 0.004 * wave(13 * u + 11 * v) + 0.002 * wave(9 * u - 17 * v);
                tile[k] =
                    (float)(lumps + scratches + 0.05 / size * grain((uint32_t)(j * 8191 + i)));
            }
        }
    return field;
}

static WrImage *bench_colour(WrError *err)
{
    WrImage *image = wr_image_new(COLOUR_SIZE, COLOUR_SIZE, 3, err);
    if (!image) return NULL;
    static const float tones[2][3] = { { 0.10f, 0.05f, 0.27f }, { 0.58f, 0.31f, 0.10f } };
    for (int j = 0; j < COLOUR_SIZE; j++)
        for (int i = 0; i < COLOUR_SIZE; i++) {
            int check = ((i * 16 / COLOUR_SIZE) + (j * 8 / COLOUR_SIZE)) & 1;
            float fleck = 0.1f * (float)grain((uint32_t)(j * 131071 + i));
            for (int c = 0; c < 3; c++)
                image->data[(j * COLOUR_SIZE + i) * 3 + c] = tones[check][c] + fleck;
        }
    return image;
}

/* A bicubic patch that is regular everywhere and fills the view. */
static const double patch[16][3] = {
    { -1.25, -1.15, -.10 }, { -.45, -1.25, .45 }, { .45, -1.20, -.35 }, { 1.25, -1.15, .15 },
    { -1.20, -.45, .40 },   { -.40, -.40, .75 },  { .40, -.45, .05 },   { 1.20, -.40, -.30 },
    { -1.20, .45, -.25 },   { -.40, .40, .20 },   { .40, .45, .65 },    { 1.20, .40, .35 },
    { -1.25, 1.15, .20 },   { -.45, 1.25, -.40 }, { .45, 1.20, .30 },   { 1.25, 1.15, -.15 },
};

WrScene *wr_bench_scene(const char *surface, WrBenchMode mode, bool fast, WrError *err)
{
    WrScene *scene = wr_scene_new();
    WrSurfaceKind kind = (WrSurfaceKind)wr_surface_find(surface);
    wr_shape_default(kind, &scene->shape);
    if (kind == WR_SURFACE_bezier)
        for (int k = 0; k < 48; k++)
            scene->shape.value[k] = patch[k / 3][k % 3] + (k % 3 < 2 ? 0.5 : 0);
    scene->posed = kind == WR_SURFACE_bezier;
    if (kind == WR_SURFACE_torus) scene->shape.value[0] = 0.7, scene->shape.value[1] = 0.28;
    scene->camera = (WrCamera){ .eye = { 0, 0, 4 }, .up = { 0, 1, 0 } };
    /* The tangent from distance 4 to the unit sphere has the slope 1 / sqrt(4^2 - 1): the silhouette touches the
       view's edge. */
    scene->camera.fov_deg = 2 * atan(1 / sqrt(15.0)) / WR_RAD_PER_DEG;
    scene->material = (WrMaterial){ .ambient = 0.08,
                                    .diffuse = 0.72,
                                    .specular = 0.35,
                                    .shininess = 40,
                                    .colour = { 1, 1, 1 },
                                    .gate = true,
                                    .roughness = 0.3,
                                    .ior = 1.5 };
    scene->lights[0] = (WrLight){ .kind = WR_LIGHT_DIRECTIONAL,
                                  .where = { 0.36514837, 0.54772256, 0.75592895 },
                                  .colour = { 1, 1, 1 },
                                  .strength = 1 };
    scene->height = 1;
    const bool bump = mode != WR_BENCH_PHONG && mode != WR_BENCH_TEXTURE;
    scene->bump = bump ? WR_BUMP_BLINN : WR_BUMP_NONE;
    scene->dials.arithmetic = fast ? WR_ARITHMETIC_FAST : WR_ARITHMETIC_EXACT;
    scene->dials.samples = 4;
    if (mode == WR_BENCH_MIP) scene->dials.aa = WR_AA_FILTER;
    if (mode == WR_BENCH_SS16) scene->dials.aa = WR_AA_SUPERSAMPLE;
    if (mode == WR_BENCH_ADAPTIVE) scene->dials.aa = WR_AA_ADAPTIVE;
    if (mode == WR_BENCH_TEXTURE || mode == WR_BENCH_BUMP_TEXTURE) {
        scene->colour = bench_colour(err);
        if (!scene->colour) {
            wr_scene_free(scene);
            return NULL;
        }
    }
    return scene;
}

/* ---- pictures of it ---- */

/* One measurement. The renderer keeps its caches between runs, as in the window. */
typedef struct Row {
    const char *surface; /* "sphere", "bezier" or "torus" */
    int size;            /* picture of size x size pixels */
    WrBenchMode mode;
    int table;   /* texels along a side */
    int threads; /* 0: all processors */
    double ms;   /* median; filled by measure() */
    int64_t covered;
} Row;

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

int wr_bench_threads(const WrCli *cli)
{
    return cli->threads > 0 ? cli->threads : wr_pool_threads(cli->pool);
}

double wr_bench_median(double *values, int count)
{
    if (count == 0) return 0;
    qsort(values, (size_t)count, sizeof *values, ascending);
    return count & 1 ? values[count / 2] : 0.5 * (values[count / 2 - 1] + values[count / 2]);
}

/* State of one row during measurement. */
typedef struct Lane {
    WrPool *pool;
    WrRenderer *renderer;
    WrScene *scene;
    WrField *field; /* shared by the rows of one table size */
    double *ms;     /* [runs] */
} Lane;

static bool lane_init(const WrCli *cli, const Row *row, int runs, bool fast, WrField *field,
                      Lane *lane, WrError *err)
{
    lane->field = wr_field_share(field);
    lane->ms = wr_alloc((size_t)runs, sizeof *lane->ms);
    lane->pool = wr_pool_new(row->threads);
    lane->renderer = wr_renderer_new(lane->pool, cli->isa, err);
    lane->scene = lane->renderer ? wr_bench_scene(row->surface, row->mode, fast, err) : NULL;
    return lane->scene;
}

static void lane_fini(Lane *lane)
{
    wr_renderer_free(lane->renderer);
    wr_pool_free(lane->pool);
    wr_scene_free(lane->scene);
    wr_field_free(lane->field);
    wr_free(lane->ms);
}

/* Tables of the sizes that rows use, each generated once. */
static WrField *field_of(WrField **fields, const Row *rows, int index, WrError *err)
{
    for (int i = 0; i < index; i++)
        if (rows[i].table == rows[index].table) return wr_field_share(fields[i]);
    return wr_bench_field(rows[index].table > 0 ? rows[index].table : 64, err);
}

/* Measure all rows in `runs` rounds, alternating between rows. */
static bool measure(const WrCli *cli, Row *rows, int count, int runs, bool fast, WrError *err)
{
    Lane *lanes = wr_alloc((size_t)count, sizeof *lanes);
    WrField **fields = wr_alloc((size_t)count, sizeof *fields);
    bool good = true;
    for (int i = 0; i < count && good; i++) {
        fields[i] = field_of(fields, rows, i, err);
        good = fields[i] && lane_init(cli, &rows[i], runs, fast, fields[i], &lanes[i], err);
    }
    for (int run = -1; run < runs && good; run++) /* the first round fills caches and is not
                                                     counted */
        for (int i = 0; i < count && good; i++) {
            WrFrame frame;
            WrFrameRequest request = { .field = lanes[i].field,
                                       .scene = lanes[i].scene,
                                       .width = rows[i].size,
                                       .height = rows[i].size,
                                       .turn_deg = 7.3 * run,
                                       .codes = { .wanted = true } }; /* 8-bit, as displayed */
            good = wr_renderer_frame(lanes[i].renderer, &request, &frame, err);
            if (good && run >= 0) lanes[i].ms[run] = frame.times.total * 1e3;
            if (good) rows[i].covered = frame.covered;
        }
    for (int i = 0; i < count; i++) {
        if (good) rows[i].ms = wr_bench_median(lanes[i].ms, runs);
        lane_fini(&lanes[i]);
        wr_field_free(fields[i]);
    }
    wr_free(fields);
    wr_free(lanes);
    return good;
}

static int add_rows(Row *rows, int count, const char *surface, int size, int table, int threads,
                    const WrBenchMode *modes, int mode_count)
{
    for (int m = 0; m < mode_count; m++)
        rows[count++] = (Row){ .surface = surface,
                               .size = size,
                               .mode = modes[m],
                               .table = modes[m] == WR_BENCH_PHONG ? 0 : table,
                               .threads = threads };
    return count;
}

/* Print 'surface view mode table threads ms', one line per measurement, for comparison with other renderers. */
bool wr_bench_frame_lines(const WrCli *cli, bool quick, bool exact, WrText *text, WrError *err)
{
    static const WrBenchMode modes[] = { WR_BENCH_PHONG,        WR_BENCH_TEXTURE, WR_BENCH_BUMP,
                                         WR_BENCH_BUMP_TEXTURE, WR_BENCH_MIP,     WR_BENCH_SS16,
                                         WR_BENCH_ADAPTIVE };
    const int all = (int)(sizeof modes / sizeof *modes);
    static const char *const surfaces[] = { "sphere", "bezier" };
    static const int sizes[] = { 512, 1024, 2048 }, tables[] = { 512, 4096 };
    const int threads[] = { 1, wr_bench_threads(cli) };
    const int size_count = quick ? 1 : 3, table_count = quick ? 1 : 2;
    for (int s = 0; s < 2; s++)
        for (int z = 0; z < size_count; z++) {
            Row rows[ROWS_MAX];
            int count = 0;
            for (int t = 0; t < (threads[1] > 1 ? 2 : 1); t++)
                for (int k = 0; k < table_count; k++)
                    count = add_rows(rows, count, surfaces[s], sizes[z], tables[k], threads[t],
                                     modes + (k > 0), k > 0 ? 4 : all);
            if (!measure(cli, rows, count, quick ? 5 : 9, !exact, err)) return false;
            for (int i = 0; i < count; i++)
                wr_text_addf(text, "%s %d %s %d %d %.4f\n", rows[i].surface, rows[i].size,
                             wr_bench_modes[rows[i].mode], rows[i].table, rows[i].threads,
                             rows[i].ms);
        }
    return true;
}

static void print_frames(WrText *text, const Row *rows, int count)
{
    wr_text_addf(text, "%-8s %-10s %-8s %7s %9s %9s %9s\n", "surface", "view", "mode", "threads",
                 "ms", "frames/s", "ns/pixel");
    for (int i = 0; i < count; i++) {
        const Row *r = &rows[i];
        char view[32];
        snprintf(view, sizeof view, "%dx%d", r->size, r->size);
        wr_text_addf(text, "%-8s %-10s %-8s %7d %9.2f %9.0f %9.2f\n", r->surface, view,
                     r->mode == WR_BENCH_PHONG ? "smooth" : wr_bench_modes[r->mode], r->threads,
                     r->ms, 1e3 / r->ms, 1e6 * r->ms / (double)(r->covered > 0 ? r->covered : 1));
    }
}

/* Ratios to compare with the paper, section 6: the time with bump mapping is about 4 times that of smooth shading and
   about 2 times that of a colour texture. */
static void print_ratios(WrText *text, const Row *rows, int count)
{
    wr_text_addf(text, "\n%-8s %-10s %7s %12s %13s   (the paper: about 4 and 2)\n", "surface",
                 "view", "threads", "bump/smooth", "bump/texture");
    for (int i = 0; i + 2 < count; i += 3) {
        char view[32];
        snprintf(view, sizeof view, "%dx%d", rows[i].size, rows[i].size);
        wr_text_addf(text, "%-8s %-10s %7d %12.2f %13.2f\n", rows[i].surface, view, rows[i].threads,
                     rows[i + 2].ms / rows[i].ms, rows[i + 2].ms / rows[i + 1].ms);
    }
}

bool wr_bench_frame_table(const WrCli *cli, bool quick, bool exact, WrText *text, WrError *err)
{
    static const WrBenchMode modes[] = { WR_BENCH_PHONG, WR_BENCH_TEXTURE, WR_BENCH_BUMP };
    static const char *const surfaces[] = { "sphere", "bezier", "torus" };
    const int threads[] = { 1, wr_bench_threads(cli) };
    Row rows[ROWS_MAX];
    int count = 0;
    for (int s = 0; s < 3; s++)
        for (int size = 512; size <= (quick ? 512 : 1024); size *= 2)
            for (int t = 0; t < (threads[1] > 1 ? 2 : 1); t++)
                count = add_rows(rows, count, surfaces[s], size, 512, threads[t], modes, 3);
    wr_text_addf(text, "table 512x512, %s arithmetic, medians of interleaved runs\n\n",
                 exact ? "exact" : "fast");
    if (!measure(cli, rows, count, quick ? 5 : 15, !exact, err)) return false;
    print_frames(text, rows, count);
    print_ratios(text, rows, count);
    return true;
}
