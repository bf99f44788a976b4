#include "base/error.h"
#include "base/exactmath.h"
#include "base/hash.h"
#include "base/enum_rows.h"
#include "cli/bench.h"
#include "field/field.h"
#include "image/image.h"
#include "scene/dials.h"
#include "scene/scene.h"
#include "shade/bump_mode.h"
#include "surface/surface.h"

#include <math.h>
#include <string.h>

WR_ROWS(wr_bench_modes);
const char *const wr_bench_modes[WR_BENCH_MODE_COUNT] = {
    [WR_ROW(WR_BENCH_PHONG)] = "phong",         [WR_ROW(WR_BENCH_TEXTURE)] = "texture",
    [WR_ROW(WR_BENCH_BUMP)] = "bump",           [WR_ROW(WR_BENCH_BUMP_TEXTURE)] = "bump+texture",
    [WR_ROW(WR_BENCH_MIP)] = "bump_mip",        [WR_ROW(WR_BENCH_SS16)] = "ss16",
    [WR_ROW(WR_BENCH_ADAPTIVE)] = "adaptive16",
};
WR_ROWS_END(wr_bench_modes, WR_BENCH_MODE_COUNT);

#define COLOUR_SIZE 512

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
