/* Hard cases of several cells in one table, terrain from a layer's heights, and colours by height and slope. */
#include "hardcases/hardcases_later.h"
#include "field/scheme_list.h"

#include "base/error.h"
#include "base/memory.h"
#include "field/field.h"
#include "image/image.h"
#include "scene/height_colormap.h"
#include "scene/scene.h"
#include "surface/terrain.h"

#include <string.h>

/* ---- HC176: a cube's cells ---- */

/* Random heights, five times as high in the texels outside the cell of face 0, the lower left one. */
static WrField *with_cell(WrHardMeasurement *g, int w, int h, const WrField *cell)
{
    WrField *field = wr_hard_random_table(g, w, h, WR_WRAP_PERIODIC);
    for (int k = 0; k < w * h; k++) {
        const int i = k % w, j = k / w;
        const bool own = 3 * i < w && 2 * (h - 1 - j) < h;
        wr_field_set(field, i, j, own ? wr_field_get(cell, i, j) : 5 * wr_field_get(field, i, j));
    }
    return field;
}

static void look_at_face(WrScene *scene, int k)
{
    static const WrAntialias aa[] = { WR_AA_POINT, WR_AA_FILTER, WR_AA_MOMENTS };
    scene->shape = wr_hard_shape(WR_SURFACE_cube);
    scene->shape.value[1] = 6;
    scene->posed = true;
    scene->scheme = k % 2 ? WR_SCHEME_BILINEAR : WR_SCHEME_BSPLINE;
    scene->replicate_u = scene->replicate_v = 1;
    scene->height = 0.02;
    scene->dials.aa = aa[k % 3];
    scene->camera =
        (WrCamera){ .orthographic = true, .eye = { 0, 0, 5 }, .up = { 0, 1, 0 }, .size = 1.3 };
}

bool wr_hard_hc176(WrHardMeasurement *g, WrError *err)
{
    static const int sizes[][2] = { { 211, 139 }, { 192, 128 }, { 301, 190 } };
    bool good = true;
    for (int k = 0; k < 6 && good; k++) {
        const int w = sizes[k % 3][0], h = sizes[k % 3][1];
        WrScene *scene = wr_scene_new();
        WrField *cell = wr_hard_random_table(g, w, h, WR_WRAP_PERIODIC),
                *other = with_cell(g, w, h, cell);
        WrFrameRequest request = { .scene = scene, .width = 33, .height = 31 };
        look_at_face(scene, k);
        for (int way = 0; way < WR_HARD_WAYS && good; way++) {
            WrHardShot a = { .renderer = NULL }, b = { .renderer = NULL };
            request.field = cell;
            good = wr_hard_shoot_by(g, &request, (WrHardWay)way, &a, err);
            request.field = other;
            good = good && wr_hard_shoot_by(g, &request, (WrHardWay)way, &b, err);
            if (good) wr_hard_holds(g, wr_hard_precision(way), a.frame.covered > 600);
            if (good) wr_hard_holds(g, wr_hard_precision(way), wr_hard_differ(&a, &b, 0) == 0);
            wr_hard_put_away(&a);
            wr_hard_put_away(&b);
        }
        wr_field_free(other);
        wr_field_free(cell);
        wr_scene_free(scene);
    }
    return good;
}

/* ---- HC177: terrain from a layer ---- */

static const float *row_of(const void *ctx, int j, float *room)
{
    const WrField *field = ctx;
    wr_field_read(field, 0, j, wr_field_width(field), 1, room, (size_t)wr_field_width(field));
    return room;
}

typedef struct Ground {
    float (*points)[48];
    int columns, rows;
} Ground;

static bool make_ground(const WrField *field, double height, int cells, Ground *out, WrError *err)
{
    const WrTerrain terrain = { .row = row_of,
                                .ctx = field,
                                .w = wr_field_width(field),
                                .h = wr_field_height(field),
                                .a = 1.25,
                                .b = 1,
                                .height = height,
                                .cells = cells };
    return wr_terrain_points(&terrain, &out->points, &out->columns, &out->rows, err);
}

/* For a flat layer every control point has its height; for an even slope along u, every one from the second cell
   to the last but one, if the table has whole texels per cell. The layer has any valid size, including one
   texel. */
static bool plain_ground(WrHardMeasurement *g, int cells, bool rises, WrError *err)
{
    const int w = rises ? 4 * cells : 1 + (int)(40 * wr_hard_random(g));
    const int h = 1 + (int)(30 * wr_hard_random(g));
    const double level = wr_hard_between(g, 0.2, 3), height = wr_hard_between(g, 0.1, 2);
    WrField *field = wr_field_new(w, h, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, (float)level, NULL);
    Ground ground;
    for (int k = 0; k < w * h && rises; k++)
        wr_field_set(field, k % w, k / w, (float)(level * (k % w + 0.5) / w));
    const bool good = make_ground(field, height, cells, &ground, err);
    for (int k = 0; good && k < 16 * ground.columns * ground.rows; k++) {
        const float *p = ground.points[k / 16] + 3 * (k % 16);
        const int column = k / 16 % ground.columns;
        if (rises && (column < 2 || column >= ground.columns - 2)) continue;
        const double want = rises ? (double)p[0] / 1.25 * level : level;
        wr_hard_record_error(g, WR_HARD_DOUBLE, fabs((double)p[2] / (height * want) - 1));
    }
    if (good) wr_free(ground.points);
    wr_field_free(field);
    return good;
}

bool wr_hard_hc177(WrHardMeasurement *g, WrError *err)
{
    bool good = true;
    for (int k = 0; k < 40 && good; k++) {
        const int cells = 5 + (int)(59 * wr_hard_random(g));
        good = plain_ground(g, cells, k % 2, err);
    }
    for (int k = 0; k < 4 && good; k++) { /* heights at the limits of float */
        WrField *field = wr_hard_random_table(g, 1 + 6 * k, 19 - 6 * k, WR_WRAP_PERIODIC);
        Ground ground;
        for (int i = 0; i < wr_field_width(field); i++)
            wr_field_set(field, i, 0, i % 2 ? -3e38f : 3e38f);
        good = make_ground(field, k % 2 ? -1e30 : 1e30, 9, &ground, err);
        for (int i = 0; good && i < 48 * ground.columns * ground.rows; i++)
            if (!(fabsf(ground.points[i / 48][i % 48]) <= 1e30f))
                wr_hard_record_error(g, WR_HARD_DOUBLE, 1);
        if (good) wr_free(ground.points);
        wr_field_free(field);
    }
    return good;
}

/* ---- HC178: colours by height and slope ---- */

static bool is_colour(const double rgb[3], const double of[3])
{
    return rgb[0] == of[0] && rgb[1] == of[1] && rgb[2] == of[2];
}

/* Four stops, the middle two at one height. */
static void give_stops(WrHardMeasurement *g, WrHeightColormap *out)
{
    const double low = wr_hard_between(g, -2, 0), high = low + pow(10, wr_hard_between(g, -12, 2));
    const double heights[] = { low, high, high, high + 0.3 };
    *out = (WrHeightColormap){ .count = 4 };
    for (int k = 0; k < 4; k++) {
        out->stops[k].height = heights[k];
        for (int c = 0; c < 3; c++) out->stops[k].rgb[c] = wr_hard_random(g);
    }
}

static void check_stops(WrHardMeasurement *g, const WrHeightColormap *of)
{
    static const double beyond[] = { 0.1, 1e30, INFINITY };
    const WrStop *stops = of->stops;
    double rgb[3];
    for (int k = 0; k < 3; k++) {
        wr_height_colormap_at(of, stops[0].height - beyond[k], 0, rgb);
        wr_hard_holds(g, WR_HARD_DOUBLE, is_colour(rgb, stops[0].rgb));
        wr_height_colormap_at(of, stops[3].height + beyond[k], 0, rgb);
        wr_hard_holds(g, WR_HARD_DOUBLE, is_colour(rgb, stops[3].rgb));
    }
    wr_height_colormap_at(of, stops[1].height, 0, rgb);
    wr_hard_holds(g, WR_HARD_DOUBLE, is_colour(rgb, stops[2].rgb));
    for (int k = 0; k < 8; k++) { /* linear between the first two */
        const double t = wr_hard_random(g);
        const double at = stops[0].height + t * (stops[1].height - stops[0].height);
        if (!(at < stops[1].height)) continue;
        const double s = (at - stops[0].height) / (stops[1].height - stops[0].height);
        wr_height_colormap_at(of, at, 0, rgb);
        for (int c = 0; c < 3; c++)
            wr_hard_holds(g, WR_HARD_DOUBLE,
                          fabs(rgb[c] - (stops[0].rgb[c] * (1 - s) + stops[1].rgb[c] * s)) < 1e-12);
    }
}

/* The angle at which the colour starts equals the angle of full strength: a step. */
static void check_steep(WrHardMeasurement *g, WrHeightColormap *of)
{
    const double angle = wr_hard_between(g, 5, 85), height = of->stops[3].height + 1;
    double rgb[3];
    of->steep = true;
    of->slope[0] = of->slope[1] = angle;
    for (int c = 0; c < 3; c++) of->steep_rgb[c] = 2 + wr_hard_random(g);
    wr_height_colormap_at(of, height, nextafter(angle, 0), rgb);
    wr_hard_holds(g, WR_HARD_DOUBLE, is_colour(rgb, of->stops[3].rgb));
    wr_height_colormap_at(of, height, angle, rgb);
    for (int c = 0; c < 3; c++)
        wr_hard_holds(g, WR_HARD_DOUBLE, fabs(rgb[c] - of->steep_rgb[c]) < 1e-12);
}

/* Cliffs as high as float's maximum are steep, not NaN; a rolled table produces the rolled picture, to the bit. */
static bool check_table(WrHardMeasurement *g, const WrHeightColormap *of, WrError *err)
{
    WrField *field = wr_hard_random_table(g, 13, 9, WR_WRAP_PERIODIC);
    wr_field_set(field, 0, 4, 3e38f);
    wr_field_set(field, 2, 4, -3e38f);
    WrField *rolled = wr_hard_rolled(field, 5, 4);
    WrImage *a = wr_height_colormap_table(of, field, 1, err);
    WrImage *b = a ? wr_height_colormap_table(of, rolled, 1, err) : NULL;
    for (int k = 0; b && k < 13 * 9; k++) {
        const int from = (k % 13 + 5) % 13 + 13 * ((k / 13 + 4) % 9);
        const float *to = b->data + (size_t)3 * (size_t)k;
        wr_hard_holds(g, WR_HARD_FLOAT,
                      memcmp(to, a->data + (size_t)3 * (size_t)from, 3 * sizeof *to) == 0 &&
                          isfinite(to[0] + to[1] + to[2]));
        if (from == 1 + 13 * 4)
            wr_hard_holds(g, WR_HARD_FLOAT, fabs((double)to[0] - of->steep_rgb[0]) < 1e-6);
    }
    const bool good = b != NULL;
    wr_image_free(a);
    wr_image_free(b);
    wr_field_free(rolled);
    wr_field_free(field);
    return good;
}

bool wr_hard_hc178(WrHardMeasurement *g, WrError *err)
{
    bool good = true;
    for (int k = 0; k < 60 && good; k++) {
        WrHeightColormap of;
        give_stops(g, &of);
        check_stops(g, &of);
        check_steep(g, &of);
        good = check_table(g, &of, err);
    }
    return good;
}
