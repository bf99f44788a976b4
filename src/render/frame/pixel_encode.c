#include "render/frame/pixel_encode.h"

#include "base/memory.h"
#include "base/pool.h"
#include "base/vec.h"
#include "scene/scene.h"

#include <string.h>

int64_t wr_code_row(const WrPixelEncoder *coder, const WrBehind *behind, int across, int count,
                    const float *rgba, uint32_t *out)
{
    const WrKernels *k = coder->kernels;
    if (coder->tone.plain && !across)
        return k->codes_over(coder->bins, behind->colour, count, rgba, out);
    _Static_assert(sizeof *behind == sizeof(float[4]), "a colour and its code are four floats");
    int64_t not_finite = 0;
    for (int x = 0; x < count; x += WR_SPAN) {
        const int some = count - x < WR_SPAN ? count - x : WR_SPAN;
        float own[WR_SPAN][4];
        for (int i = 0; i < some; i++)
            memcpy(own[i], behind[(x + i) * across].colour, sizeof behind->colour);
        not_finite +=
            k->codes_behind(coder->bins, &coder->tone, own[0], some, rgba + 4 * (size_t)x, out + x);
    }
    return not_finite;
}

static void give(double to[3], const double axes[9], WrVec3 d)
{
    for (int k = 0; k < 3; k++)
        to[k] = axes[3 * k] * d.x + axes[3 * k + 1] * d.y + axes[3 * k + 2] * d.z;
}

/* Camera rays into the environment; false: the scene shows no environment. */
static bool look_out(const WrScene *scene, double radius, int width, int height, WrOutlook *out)
{
    const WrEnvironment *own = scene ? &scene->environment : NULL;
    const double aspect = (double)width / height;
    WrPlacement place;
    double axes[9];
    if (!own || !own->light) return false;
    if (!(radius > 0 ? wr_scene_place_sized(scene, radius, 0, aspect, &place, NULL)
                     : wr_scene_place(scene, 0, aspect, &place, NULL)))
        return false;
    const double high = place.orthographic ? 0 : place.half_height, wide = high * aspect;
    const WrVec3 right = v3_scale(place.right, 2 * wide / width),
                 down = v3_scale(place.up, -2 * high / height);
    WrVec3 first = v3_mad(v3_mad(place.forward, place.right, -wide), place.up, high);
    first = v3_mad(v3_mad(first, right, 0.5), down, 0.5);
    memset(out, 0, sizeof *out); /* compared as bytes */
    wr_environment_map_turn(own->turn_deg, axes);
    out->light = own->light;
    out->strength = own->strength;
    give(out->first, axes, first);
    give(out->right, axes, right);
    give(out->down, axes, down);
    return true;
}

typedef struct Fill {
    WrBackdrop *backdrop;
    const WrPixelEncoder *coder;
} Fill;

/* The direction is linear in the pixel position, from the first pixel's centre. */
static void fill_row(int row, int worker, void *ctx)
{
    (void)worker;
    const Fill *fill = ctx;
    WrBackdrop *b = fill->backdrop;
    const WrOutlook *o = &b->outlook;
    WrBehind *cells = b->cells + (size_t)row * (size_t)b->step;
    const double y = b->first + row;
    for (int x = 0; x < b->width; x++) {
        const float nothing[4] = { 0 };
        double rgb[3];
        const WrVec3 d = { o->first[0] + x * o->right[0] + y * o->down[0],
                           o->first[1] + x * o->right[1] + y * o->down[1],
                           o->first[2] + x * o->right[2] + y * o->down[2] };
        wr_environment_map_at(o->light, d, rgb);
        for (int c = 0; c < 3; c++) cells[x].colour[c] = (float)(o->strength * rgb[c]);
        wr_code_row(fill->coder, &cells[x], 0, 1, nothing, &cells[x].code);
    }
}

static void make_room(WrBackdrop *backdrop, size_t count)
{
    if (backdrop->room >= count) return;
    wr_free(backdrop->cells);
    backdrop->cells = wr_alloc(count, sizeof *backdrop->cells);
    backdrop->room = count;
}

static bool stands(const WrBackdrop *b, const WrOutlook *outlook, const WrTone *tone, int width,
                   int height, int first, int rows)
{
    return b->held && memcmp(&b->outlook, outlook, sizeof *outlook) == 0 &&
           wr_tone_equal(&b->tone, tone) && b->width == width && b->height == height &&
           b->first == first && b->rows == rows;
}

static void drop(WrBackdrop *backdrop)
{
    wr_environment_map_free(backdrop->held);
    backdrop->held = NULL;
}

/* Fills one colour, or one for each row. */
static void fill_rows(WrBackdrop *b, const WrBackground *ground, int height, int first, int rows,
                      const WrPixelEncoder *coder)
{
    const float nothing[4] = { 0 };
    drop(b);
    b->step = ground->kind == WR_BACKGROUND_GRADIENT;
    b->across = 0;
    make_room(b, b->step ? (size_t)rows : 1);
    for (int i = 0; i < (b->step ? rows : 1); i++) {
        wr_background_row(ground, first + i, height, b->cells[i].colour);
        wr_code_row(coder, &b->cells[i], 0, 1, nothing, &b->cells[i].code);
    }
}

void wr_backdrop_update(WrBackdrop *backdrop, const WrFrameCodes *of, double radius, int width,
                        int height, int first, int rows, const WrPixelEncoder *coder, WrPool *pool)
{
    WrOutlook outlook;
    if (of->background.kind != WR_BACKGROUND_SURROUNDINGS ||
        !look_out(of->scene, radius, width, height, &outlook)) {
        fill_rows(backdrop, &of->background, height, first, rows, coder);
        return;
    }
    if (stands(backdrop, &outlook, &of->tone, width, height, first, rows)) return;
    drop(backdrop);
    make_room(backdrop, (size_t)width * (size_t)rows);
    backdrop->held = wr_environment_map_share(outlook.light);
    backdrop->outlook = outlook;
    backdrop->tone = of->tone;
    backdrop->width = backdrop->step = width;
    backdrop->height = height;
    backdrop->first = first, backdrop->rows = rows;
    backdrop->across = 1;
    Fill fill = { backdrop, coder };
    wr_pool_run(pool, rows, fill_row, &fill);
}

void wr_backdrop_fini(WrBackdrop *backdrop)
{
    drop(backdrop);
    wr_free(backdrop->cells);
    *backdrop = (WrBackdrop){ 0 };
}
