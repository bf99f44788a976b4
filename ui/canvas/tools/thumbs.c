/* Thumbnails of presets, loaded and scaled on a separate thread, a few at a time; presets without a picture paint a
   sample. */
#include "ui/canvas/tools/thumbs.h"
#include "ui/canvas/canvas_colors.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/registry.h"
#include "ui/canvas/tools/preset_browser.h"
#include "ui/canvas/tools/tool_stamp.h"
#include "ui/app/jobs/job.h"
#include "ui/toolkit/gui_sdl_renderer.h"

#include "base/array.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "brush/brush.h"
#include "brush/library.h"
#include "brush/preset.h"
#include "brush/symmetry.h"
#include "brush/tip.h"
#include "field/field.h"
#include "image/image.h"

#include <SDL.h>
#include <math.h>
#include <string.h>

#define BATCH 6           /* pictures per job */
#define PAINTED_TEXELS 96 /* side of the table for painted samples */

typedef struct Item {
    int slot;                  /* that it is for */
    char *id, *path, *picture; /* owned; picture may be NULL, path too: the round brush */
    char *stamp;               /* path of a stamp, owned; alternative to these */
    uint32_t *argb;            /* [side * side], owned; NULL: failed */
} Item;

typedef struct Batch {
    int count, side;
    uint64_t round; /* round of the requests; older ones are dropped */
    Item items[BATCH];
} Batch;

typedef struct Slot {
    SDL_Texture *texture; /* owned */
    bool asked, failed;
} Slot;

struct WrThumbs {
    WrJob *job;
    WR_ARRAY(Slot) slots; /* presets at 2 (index + 1), stamps at 2 index + 1 */
    WR_ARRAY(int) wishes; /* slots visible in this frame that have no picture yet */
    int side;
    uint64_t round;
    uint64_t of; /* serial number of the slots */
};

/* ---- on the worker thread ---- */

static void drop(void *arg)
{
    Batch *batch = arg;
    for (int i = 0; i < batch->count; i++) {
        Item *item = &batch->items[i];
        wr_free(item->id);
        wr_free(item->path);
        wr_free(item->picture);
        wr_free(item->stamp);
        wr_free(item->argb);
    }
    wr_free(batch);
}

static uint32_t code(double x)
{
    return (uint32_t)(x < 0.0 ? 0.0 : x > 1.0 ? 255.0 : floor(x * 255.0 + 0.5));
}

/* Mean grey of a box of pixels, since a brush paints heights, not colours; composited over the background of
   fields. */
static uint32_t box_mean(const WrImage *image, int x0, int y0, int x1, int y1)
{
    double sum[3] = { 0 };
    int c = image->channels;
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++) {
            const float *p =
                image->data + ((size_t)y * (size_t)image->width + (size_t)x) * (size_t)c;
            double alpha = c == 2 ? (double)p[1] : c == 4 ? (double)p[3] : 1.0;
            for (int k = 0; k < 3; k++)
                sum[k] += alpha * (double)p[c >= 3 ? k : 0] + (1.0 - alpha) * (0x1f / 255.0);
        }
    double n = (double)(x1 - x0) * (y1 - y0);
    const uint32_t grey = code((0.2126 * sum[0] + 0.7152 * sum[1] + 0.0722 * sum[2]) / n);
    return 0xff000000u | grey << 16 | grey << 8 | grey;
}

/* The middle square of a picture, scaled to side x side. */
static void shrink(const WrImage *image, int side, uint32_t *argb)
{
    int w = image->width, h = image->height, least = w < h ? w : h;
    int left = (w - least) / 2, top = (h - least) / 2;
    for (int y = 0; y < side; y++)
        for (int x = 0; x < side; x++) {
            int x0 = (int)((int64_t)x * least / side), x1 = (int)((int64_t)(x + 1) * least / side);
            int y0 = (int)((int64_t)y * least / side), y1 = (int)((int64_t)(y + 1) * least / side);
            x1 = x1 > x0 ? x1 : x0 + 1;
            y1 = y1 > y0 ? y1 : y0 + 1;
            argb[y * side + x] = box_mean(image, left + x0, top + y0, left + x1, top + y1);
        }
}

/* Provide heights for modes that only change existing ones. */
static void prepare_ground(const WrBrush *brush, WrField *field)
{
    const WrBrushModeInfo *mode = &wr_brush_modes[brush->mode];
    if (mode->uses & WR_USES_STRENGTH && !mode->moves) return;
    for (int j = 0; j < PAINTED_TEXELS; j++)
        for (int i = 0; i < PAINTED_TEXELS; i++) {
            double a = sin(i * 0.26) * sin(j * 0.26);
            wr_field_set(field, i, j, (float)(0.05 * a));
        }
}

/* An S on a flat table, from left to right, with more pressure in its middle. */
static void paint_sample(const WrBrush *of, WrField *field)
{
    WrBrush brush = *of;
    double most = PAINTED_TEXELS / 8.0;
    brush.radius = brush.radius > most || !(brush.radius > 0.0) ? most : brush.radius;
    brush.radius = brush.radius < 4.0 ? 4.0 : brush.radius;
    brush.symmetry = (WrSymmetry){ 0 };
    WrStroke *stroke = wr_stroke_new(field, &brush);
    for (int i = 0; i <= 32; i++) {
        double t = i / 32.0;
        WrSample sample = { .u = 0.14 + 0.72 * t,
                            .v = 0.5 + 0.2 * sin(6.283185307179586 * t),
                            .pressure = sin(3.141592653589793 * t) * 0.8 + 0.2,
                            .seconds = t };
        wr_stroke_add(stroke, sample);
    }
    wr_stroke_finish(stroke);
}

/* Shading from the upper left, to show the relief. */
static void emboss(const WrField *field, int side, uint32_t *argb)
{
    float low, high;
    wr_field_range(field, &low, &high);
    double range = fmax((double)high - (double)low, 1e-9);
    for (int y = 0; y < side; y++)
        for (int x = 0; x < side; x++) {
            int i = (int)((x + 0.5) * PAINTED_TEXELS / side), di = i > 0 ? i - 1 : 0;
            int j = (int)((y + 0.5) * PAINTED_TEXELS / side), dj = j > 0 ? j - 1 : 0;
            double f = (double)wr_field_get(field, i, j), g = (double)wr_field_get(field, di, dj);
            uint32_t c = code(0.33 + 1.6 * (f - g) / range);
            argb[y * side + x] = 0xff000000u | c << 16 | c << 8 | c;
        }
}

static bool paint(const Item *item, int side, uint32_t *argb)
{
    WrError err;
    int n = PAINTED_TEXELS;
    WrField *field = wr_field_new(n, n, WR_WRAP_CLAMP, WR_WRAP_CLAMP, 0.0f, &err);
    if (!field) return false;
    WrPreset *preset = item->path ? wr_preset_read(item->path, item->id, &err) : NULL;
    WrBrush brush = preset ? wr_preset_brush(preset) : wr_brush_default();
    bool ok = preset || !item->path;
    if (ok) prepare_ground(&brush, field);
    if (ok) paint_sample(&brush, field);
    if (ok) emboss(field, side, argb);
    wr_preset_free(preset);
    wr_field_free(field);
    return ok;
}

/* The first cell, bright where it paints. */
static bool print_stamp(const char *path, int side, uint32_t *argb)
{
    WrError err;
    WrTipView view;
    int w, h;
    WrTip *tip = wr_tip_read(path, &err);
    if (!tip) return false;
    wr_tip_size(tip, 0, &w, &h);
    double longer = w > h ? w : h, over = 1.0 - 2.0 / side; /* leaves a margin */
    wr_tip_view(tip, 0, side / longer, &view);
    for (int y = 0; y < side; y++)
        for (int x = 0; x < side; x++) {
            double s = ((x + 0.5) / side - 0.5) * longer / w / over + 0.5;
            double t = ((y + 0.5) / side - 0.5) * longer / h / over + 0.5;
            uint32_t c = code(0.12 + 0.82 * (double)wr_tip_value(&view, s, t));
            argb[y * side + x] = 0xff000000u | c << 16 | c << 8 | c;
        }
    wr_tip_free(tip);
    return true;
}

static void make(Item *item, int side)
{
    WrError err;
    uint32_t *argb = wr_alloc((size_t)side * (size_t)side, sizeof *argb);
    if (item->stamp) {
        if (print_stamp(item->stamp, side, argb)) item->argb = argb;
        else wr_free(argb);
        return;
    }
    WrImage *image = item->picture ? wr_image_read(item->picture, &err) : NULL;
    bool ok = image != NULL;
    if (image) shrink(image, side, argb);
    else ok = paint(item, side, argb);
    wr_image_free(image);
    if (ok) item->argb = argb;
    else wr_free(argb);
}

static void run(void *arg, WrPool *pool, const WrProgress *progress)
{
    Batch *batch = arg;
    (void)pool;
    for (int i = 0; i < batch->count && !wr_progress_cancelled(progress); i++)
        make(&batch->items[i], batch->side);
}

/* ---- on the window's thread ---- */

static void thumbs_forget(WrApp *app)
{
    WrThumbs *thumbs = app->shelf->thumbs;
    if (!thumbs) return;
    for (int i = 0; i < thumbs->slots.count; i++)
        if (thumbs->slots.data[i].texture) SDL_DestroyTexture(thumbs->slots.data[i].texture);
    thumbs->slots.count = thumbs->wishes.count = 0;
    thumbs->round++;
    wr_job_cancel(thumbs->job);
}

static WrThumbs *thumbs_of(WrApp *app)
{
    static const WrJobKind kind = { run, drop };
    WrThumbs *there = app->shelf->thumbs;
    if (there && there->of != app->shelf->serial) { /* another library */
        thumbs_forget(app);
        there->of = app->shelf->serial;
    }
    if (there) return there;
    WrThumbs *thumbs = wr_alloc(1, sizeof *thumbs);
    thumbs->job = wr_job_new(&kind, 1, app->job_event);
    thumbs->of = app->shelf->serial;
    return app->shelf->thumbs = thumbs;
}

void wr_thumbs_free(WrApp *app)
{
    WrThumbs *thumbs = app->shelf->thumbs;
    if (!thumbs) return;
    thumbs_forget(app);
    wr_job_free(thumbs->job);
    wr_array_free(&thumbs->slots);
    wr_array_free(&thumbs->wishes);
    wr_free(thumbs);
    app->shelf->thumbs = NULL;
}

/* Slots are numbered by two interleaved sequences, so that both lists can grow: slot 0 is the brush without a preset, 2 (k +
   1) preset k, 2 k + 1 stamp k. A side between half the loaded one and the loaded one
   reuses its textures (drawn smaller), so that
   dragging the width of the panel does not load everything again. */
static SDL_Texture *picture_of(WrApp *app, int place, int side)
{
    WrThumbs *thumbs = thumbs_of(app);
    side = side < 8 ? 8 : side > WR_THUMB_MAX ? WR_THUMB_MAX : side;
    if (side > thumbs->side || side < thumbs->side / 2) { /* another scale */
        thumbs_forget(app);
        thumbs->side = side;
    }
    while (thumbs->slots.count <= place) wr_array_push(&thumbs->slots, ((Slot){ 0 }));
    const Slot *slot = &thumbs->slots.data[place];
    if (!slot->texture && !slot->asked && !slot->failed) wr_array_push(&thumbs->wishes, place);
    return slot->texture;
}

SDL_Texture *wr_thumb_of(WrApp *app, int index, int side)
{
    return picture_of(app, 2 * (index + 1), side);
}

SDL_Texture *wr_thumb_of_stamp(WrApp *app, int index, int side)
{
    return picture_of(app, 2 * index + 1, side);
}

/* Textures belong to the window's thread and are therefore created here, not in the job. A batch of an older round belongs to
   slots that were dropped since (other library, other scale); its results are freed unused. */
static void take(WrApp *app, Batch *batch)
{
    WrThumbs *thumbs = app->shelf->thumbs;
    for (int i = 0; i < batch->count && batch->round == thumbs->round; i++) {
        const Item *item = &batch->items[i];
        Slot *slot = &thumbs->slots.data[item->slot];
        slot->failed = !item->argb;
        if (!item->argb) continue;
        slot->texture = SDL_CreateTexture(app->renderer, SDL_PIXELFORMAT_ARGB8888,
                                          SDL_TEXTUREACCESS_STATIC, batch->side, batch->side);
        if (slot->texture) wr_gui_sdl_update(slot->texture, NULL, item->argb, batch->side * 4);
    }
    drop(batch);
    wr_app_redraw(app);
}

/* Describe the work for a slot; false if the slot is gone. */
static bool describe(WrApp *app, int place, Item *item)
{
    const WrLibrary *library = wr_preset_browser_library(app);
    int index = place / 2 - (place % 2 ? 0 : 1);
    if (place % 2) {
        if (index >= app->stamp->stamps.count) return false;
        item->stamp = wr_strdup(app->stamp->stamps.data[index]);
    } else if (index >= 0) {
        if (index >= wr_library_count(library)) return false;
        const WrPresetEntry *entry = wr_library_entry(library, index);
        item->id = wr_strdup(entry->id);
        item->path = wr_strdup(entry->path);
        item->picture = entry->picture ? wr_strdup(entry->picture) : NULL;
    }
    item->slot = place;
    return true;
}

/* Wishes are those of the last frame only: a thumbnail that was scrolled out of view before its turn is not loaded. The job
   owns copies of all paths, because the library may be replaced meanwhile. `asked` stays set after a failure, so a broken
   file is read once. */
static void ask(WrApp *app)
{
    WrThumbs *thumbs = app->shelf->thumbs;
    Batch *batch = wr_alloc(1, sizeof *batch);
    batch->side = thumbs->side;
    batch->round = thumbs->round;
    for (int i = 0; i < thumbs->wishes.count && batch->count < BATCH; i++) {
        int place = thumbs->wishes.data[i];
        if (thumbs->slots.data[place].asked) continue;
        thumbs->slots.data[place].asked = true;
        if (describe(app, place, &batch->items[batch->count])) batch->count++;
    }
    wr_job_start(thumbs->job, batch);
}

void wr_thumbs_update(WrApp *app)
{
    WrThumbs *thumbs = app->shelf->thumbs ? thumbs_of(app) : NULL;
    if (!thumbs) return;
    Batch *done = wr_job_take(thumbs->job);
    if (done) take(app, done);
    if (thumbs->wishes.count > 0 && !wr_job_busy(thumbs->job, NULL, NULL)) ask(app);
    thumbs->wishes.count = 0;
}

const WrPart wr_part_thumbs = { .forget = thumbs_forget };
