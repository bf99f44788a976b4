/* Hard cases of normal maps: codes, signs, and extreme slopes. */
#include "hardcases/hardcases_internal.h"

#include "field/field.h"
#include "image/image.h"
#include "render/frame/frame.h"
#include "scene/normal_map.h"
#include "scene/scene.h"

#define SIDE 12
#define TEXELS (SIDE * SIDE)

/* ---- maps ---------------------------------------------------------------------------------------- */

static WrImage *blank(WrPixelType type, int channels)
{
    WrImage *image = wr_image_new(SIDE, SIDE, channels, NULL);
    image->type = type;
    return image;
}

/* True if it is unit and finite, and its slopes are finite and have the signs of the input. */
static bool tame(const float n[3])
{
    double p, q;
    wr_normal_map_slopes(n, &p, &q);
    const double square =
        (double)n[0] * (double)n[0] + (double)n[1] * (double)n[1] + (double)n[2] * (double)n[2];
    return isfinite(p) && isfinite(q) && fabs(square - 1) < 1e-6 && n[2] > 0 &&
           p * (double)n[0] <= 0 && q * (double)n[1] <= 0;
}

/* Pictures of the map on a plane or a sphere, in each arithmetic, without the table's bump; takes ownership of
   the map. */
static bool shoot_map(WrHardGauge *g, WrImage *map, double strength, double repeat, WrAntialias aa,
                      bool wanted_flat, WrError *err)
{
    WrField *field = wr_field_new(8, 8, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    WrScene *scene = wr_scene_new();
    bool good = true;
    scene->shape = wr_hard_shape(wanted_flat ? WR_SURFACE_plane : WR_SURFACE_sphere);
    scene->dials.aa = aa;
    scene->normals = (WrNormalMap){ .image = map, .strength = strength };
    if (repeat != 1)
        scene->normals.laid = (WrTextureSample){ .own = true, .ru = repeat, .rv = repeat };
    for (int way = 0; way < WR_HARD_WAYS && good; way++) {
        const WrFrameRequest request = {
            .field = field, .scene = scene, .width = 40, .height = 40
        };
        const WrHardPrecision precision = way == WR_HARD_WIDE ? WR_HARD_DOUBLE : WR_HARD_FLOAT;
        WrHardShot with = { .renderer = NULL }, without = { .renderer = NULL };
        good = wr_hard_shoot_by(g, &request, (WrHardWay)way, &with, err);
        if (good) wr_hard_holds(g, precision, wr_hard_wild(&with) == 0);
        if (good && wanted_flat) {
            scene->normals.strength = 0;
            good = wr_hard_shoot_by(g, &request, (WrHardWay)way, &without, err);
            scene->normals.strength = strength;
            if (good) wr_hard_holds(g, precision, wr_hard_differ(&with, &without, 0) == 0);
        }
        wr_hard_put_away(&with);
        wr_hard_put_away(&without);
    }
    wr_scene_free(scene);
    wr_field_free(field);
    return good;
}

/* ---- codes --------------------------------------------------------------------------------------- */

/* All 128: it stands for 0, and pictures are those without a map. Half of them 127: neither stands for 0, and
   both lean equally. Floats: 0. */
static bool hc137(WrHardGauge *g, WrError *err)
{
    WrNormalTold told;
    WrImage *file = blank(WR_PIXEL_U8, 3);
    for (int i = 0; i < 3 * TEXELS; i++) file->data[i] = (float)((i % 3 < 2 ? 128 : 255) / 255.0);
    WrImage *map = wr_normal_map_read(file, WR_GREEN_UP, 0, WR_CODING_AUTO, &told, err);
    wr_hard_holds(g, WR_HARD_DOUBLE, told.centred && map->data[0] == 0 && map->data[1] == 0);
    bool good = shoot_map(g, map, 1, 1, WR_AA_POINT, true, err);
    for (int i = 0; i < 3 * TEXELS; i += 6)
        file->data[i] = file->data[i + 1] = (float)(127 / 255.0);
    map = wr_normal_map_read(file, WR_GREEN_UP, 0, WR_CODING_AUTO, &told, err);
    wr_hard_holds(g, WR_HARD_DOUBLE, !told.centred);
    for (int i = 0; i < 3 * TEXELS; i += 3) {
        const double lean = hypot((double)map->data[i], (double)map->data[i + 1]);
        wr_hard_holds(g, WR_HARD_DOUBLE, fabs(lean - sqrt(2.0) / 255) < 1e-6);
    }
    wr_image_free(map);
    wr_image_free(file);
    return good;
}

/* Two channels, random: also outside the unit circle. */
static bool hc138(WrHardGauge *g, WrError *err)
{
    WrNormalTold told;
    WrImage *file = blank(WR_PIXEL_U16, 3);
    int64_t beyond = 0;
    for (int i = 0; i < 3 * TEXELS; i++)
        file->data[i] = (float)(floor(65535 * wr_hard_random(g)) / 65535);
    for (int i = 0; i < 3 * TEXELS; i += 3) {
        const double x = 2 * (double)file->data[i] - 1, y = 2 * (double)file->data[i + 1] - 1;
        beyond += x * x + y * y >= 1 - WR_NORMAL_LEAST * WR_NORMAL_LEAST;
    }
    WrImage *map = wr_normal_map_read(file, WR_GREEN_UP, 2, WR_CODING_AUTO, &told, err);
    for (int i = 0; i < 3 * TEXELS; i += 3) wr_hard_holds(g, WR_HARD_DOUBLE, tame(map->data + i));
    wr_hard_holds(g, WR_HARD_DOUBLE, told.away == beyond && beyond > 0);
    wr_image_free(file);
    return shoot_map(g, map, 1, 3, WR_AA_POINT, false, err);
}

/* Three channels, every direction; some texels (0,0,0), which is (-1,-1,-1). */
static bool hc139(WrHardGauge *g, WrError *err)
{
    WrNormalTold told;
    WrImage *file = blank(WR_PIXEL_U8, 3);
    int64_t away = 0;
    for (int i = 0; i < TEXELS; i++) {
        float *t = file->data + 3 * i;
        for (int c = 0; c < 3 && i % 5; c++) t[c] = (float)(floor(256 * wr_hard_random(g)) / 255);
        const double x = 2 * (double)t[0] - 1, y = 2 * (double)t[1] - 1, z = 2 * (double)t[2] - 1;
        away += z / sqrt(x * x + y * y + z * z) < WR_NORMAL_LEAST;
    }
    WrImage *map = wr_normal_map_read(file, WR_GREEN_UP, 0, WR_CODING_AUTO, &told, err);
    for (int i = 0; i < TEXELS; i++) {
        const float *t = file->data + 3 * i, *n = map->data + 3 * i;
        const double x = 2 * (double)t[0] - 1, y = 2 * (double)t[1] - 1;
        wr_hard_holds(g, WR_HARD_DOUBLE, tame(n) && x * (double)n[0] >= 0 && y * (double)n[1] >= 0);
    }
    wr_hard_holds(g, WR_HARD_DOUBLE, told.away == away && away >= TEXELS / 5);
    wr_image_free(file);
    return shoot_map(g, map, 1, 3, WR_AA_FILTER, false, err);
}

/* ---- ambiguous or invisible cases ---------------------------------------------------------------- */

/* f(u) + g(v), or f(u + v): green down, 8 bits. */
static WrImage *waves(bool apart, double power)
{
    WrImage *file = blank(WR_PIXEL_U8, 3);
    for (int i = 0; i < TEXELS; i++) {
        const double a = 6.283185307179586, u = (i % SIDE + 0.5) / SIDE,
                     v = 1 - (i / SIDE + 0.5) / SIDE;
        const double p = 0.3 * cos(a * (apart ? u : u + v)), q = 0.3 * cos(a * (apart ? v : u + v));
        const double length = sqrt(1 + p * p + q * q);
        const double n[3] = { -p / length, q / length, 1 / length };
        for (int c = 0; c < 3; c++)
            file->data[3 * i + c] = (float)(floor(255 * pow(n[c] / 2 + 0.5, power) + 0.5) / 255);
    }
    return file;
}

static bool hc140(WrHardGauge *g, WrError *err)
{
    for (int apart = 0; apart < 2; apart++) {
        WrNormalTold told;
        WrImage *file = waves(apart, 1);
        WrImage *map = wr_normal_map_read(file, WR_GREEN_AUTO, 0, WR_CODING_AUTO, &told, err);
        wr_hard_holds(g, WR_HARD_DOUBLE,
                      apart ? told.undecided && !told.green_down
                            : !told.undecided && told.green_down);
        wr_image_free(map);
        wr_image_free(file);
    }
    return true;
}

static bool hc141(WrHardGauge *g, WrError *err)
{
    static const double powers[] = { 1, 2.2, 1 / 2.2 };
    for (int k = 0; k < 3; k++) {
        WrNormalTold told;
        WrImage *file = waves(false, powers[k]);
        WrImage *map = wr_normal_map_read(file, WR_GREEN_UP, 0, WR_CODING_AUTO, &told, err);
        wr_hard_holds(g, WR_HARD_DOUBLE, told.converted == (k > 0));
        wr_image_free(map);
        wr_image_free(file);
    }
    return true;
}

/* The steepest slopes that a map can hold, of either sign side by side, with strength 100, repeated a billion
   times: their moments. */
static bool hc142(WrHardGauge *g, WrError *err)
{
    bool good = true;
    for (int k = 0; k < 4 && good; k++) {
        WrNormalTold told;
        WrImage *file = blank(WR_PIXEL_F32, 3);
        for (int i = 0; i < TEXELS; i++) {
            file->data[3 * i] = wr_hard_random(g) < 0.5 ? -1 : 1;
            file->data[3 * i + 1] = wr_hard_random(g) < 0.5 ? -1 : 1;
            file->data[3 * i + 2] = 0;
        }
        WrImage *map = wr_normal_map_read(file, WR_GREEN_UP, 0, WR_CODING_AUTO, &told, err);
        for (int i = 0; i < 3 * TEXELS; i += 3)
            wr_hard_holds(g, WR_HARD_DOUBLE, tame(map->data + i));
        good = shoot_map(g, map, 100, k % 2 ? 1e9 : 3, k / 2 ? WR_AA_MOMENTS : WR_AA_FILTER, false,
                         err);
        wr_image_free(file);
    }
    return good;
}

#define MAP(number, situation, rule, floats)                                                       \
    {                                                                                              \
        .id = "HC" #number, .subject = WR_HARD_GEOMETRY, .what = situation, .holds = rule,         \
        .unit = "violations", .bound = { floats, 0 }, .measure = hc##number                        \
    }
static const WrHardCase rows[] = {
    MAP(137, "a normal map whose flat texels are 128,128",
        "that code is 0, which is told, and the picture is the one without; float numbers are "
        "exact",
        0),
    MAP(138, "two channels with x^2 + y^2 above 1", "on the rim, finite, counted", 0),
    MAP(139, "texels 0,0,0: vectors that look away",
        "slopes keep their signs and stay finite; counted", 0),
    MAP(140, "green down, of f(u) + g(v)", "undecided, which is told; of f(u + v) it is found",
        NAN),
    MAP(141, "a normal map that went through a colour conversion", "it is told", NAN),
    MAP(142, "slopes of a thousand, times a hundred, laid a billion times",
        "means and moments are finite", 0),
};
WR_HARD_LIST(maps, rows);
