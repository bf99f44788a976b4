/* Thumbnails, loaded, painted or generated on a separate thread, a few at a time. */
#include "ui/canvas/tools/thumbs.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/registry.h"
#include "ui/canvas/tools/preset_browser.h"
#include "ui/app/jobs/edit_preview.h"
#include "ui/app/jobs/job.h"
#include "ui/toolkit/gui_sdl_renderer.h"

#include "base/array.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "base/text.h"
#include "brush/brush.h"
#include "brush/library.h"
#include "brush/preset.h"
#include "brush/tip.h"
#include "command/brush_sample.h"
#include "command/session.h"
#include "document/document.h"
#include "field/field.h"
#include "image/image.h"
#include "render/frame/frame.h"
#include "scene/scene.h"

#include <SDL.h>
#include <math.h>
#include <string.h>

#define GROUND 0.02  /* background of scenes, linear */
#define BATCH 6      /* pictures per job */
#define SIDE_MAX 256 /* pixels; larger thumbnails are drawn enlarged */

/* The texts are owned. */
typedef struct Item {
    int slot; /* that it is for */
    char *id, *path, *picture, *stamp, *scene, *line, *ground;
    bool lower, placed;
    uint32_t *argb; /* [side * side], owned; NULL: failed */
} Item;

typedef struct Batch {
    int count, side;
    WrThumbKind kind;
    uint64_t round; /* round of the kind's requests; older ones are dropped */
    Item items[BATCH];
} Batch;

typedef struct Slot {
    SDL_Texture *texture; /* owned */
    bool asked, failed;
} Slot;

struct WrThumbs {
    WrJob *job;
    WR_ARRAY(Slot) slots;  /* at index * WR_THUMB_KINDS + kind */
    WR_ARRAY(Item) wishes; /* of slots visible in this frame that have no picture yet */
    int side[WR_THUMB_KINDS];
    uint64_t round[WR_THUMB_KINDS];
    uint64_t of; /* serial number of the lists */
};

/* ---- on the worker thread ---- */

static void drop_item(Item *item)
{
    wr_free(item->id);
    wr_free(item->path);
    wr_free(item->picture);
    wr_free(item->stamp);
    wr_free(item->scene);
    wr_free(item->line);
    wr_free(item->ground);
    wr_free(item->argb);
}

static void drop(void *arg)
{
    Batch *batch = arg;
    for (int i = 0; i < batch->count; i++) drop_item(&batch->items[i]);
    wr_free(batch);
}

static uint32_t code(double x)
{
    return (uint32_t)(x < 0.0 ? 0.0 : x > 1.0 ? 255.0 : floor(x * 255.0 + 0.5));
}

/* Mean of a box of pixels, composited over the background of fields. */
static uint32_t box_mean(const WrImage *image, int x0, int y0, int x1, int y1)
{
    double sum[3] = { 0 }, n = (double)(x1 - x0) * (y1 - y0);
    int c = image->channels;
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++) {
            const float *p =
                image->data + ((size_t)y * (size_t)image->width + (size_t)x) * (size_t)c;
            double alpha = c == 2 ? (double)p[1] : c == 4 ? (double)p[3] : 1.0;
            for (int k = 0; k < 3; k++)
                sum[k] += alpha * (double)p[c >= 3 ? k : 0] + (1.0 - alpha) * (0x1f / 255.0);
        }
    return 0xff000000u | code(sum[0] / n) << 16 | code(sum[1] / n) << 8 | code(sum[2] / n);
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

/* Grey codes [side * side], opaque. */
static void grey_to_argb(const uint8_t *grey, int width, int side, uint32_t *argb)
{
    for (int y = 0; y < side; y++)
        for (int x = 0; x < side; x++)
            argb[y * side + x] = 0xff000000u | 0x010101u * grey[y * width + x];
}

/* A stroke of the preset; samples are 4:3, of which the middle is kept. */
static bool paint(const Item *item, int side, WrPool *pool, uint32_t *argb)
{
    WrError err;
    const int width = (side * 4 + 2) / 3;
    WrPreset *preset = item->path ? wr_preset_read(item->path, item->id, &err) : NULL;
    if (item->path && !preset) return false;
    WrBrushSample *sample = wr_brush_sample_new(pool, NULL, width, side, &err);
    uint8_t *grey = wr_alloc((size_t)width * (size_t)side, 1);
    bool ok = sample && wr_brush_sample_paint(sample, preset, grey, &err);
    if (ok) grey_to_argb(grey + (width - side) / 2, width, side, argb);
    wr_free(grey);
    wr_brush_sample_free(sample);
    wr_preset_free(preset);
    return ok;
}

/* Light from the upper left on a texel; steep: slope of one unit of height in a texel. */
static double light(const WrField *field, int i, int j, double steep)
{
    int w = wr_field_width(field), h = wr_field_height(field);
    double east = (double)wr_field_get(field, (i + 1) % w, j);
    double west = (double)wr_field_get(field, (i + w - 1) % w, j);
    double south = (double)wr_field_get(field, i, (j + 1) % h);
    double north = (double)wr_field_get(field, i, (j + h - 1) % h);
    double x = -(east - west) * steep, y = -(south - north) * steep;
    double facing = (-0.5 * x - 0.5 * y + 0.7071067811865476) / sqrt(x * x + y * y + 1.0);
    return 0.08 + 0.92 * (facing > 0.0 ? facing : 0.0);
}

/* The relief of a table whose side is a multiple of the picture's; its range becomes `relief` of the side. */
static void shade(const WrField *field, double relief, int side, uint32_t *argb)
{
    int texels = wr_field_width(field), step = texels / side;
    float low, high;
    wr_field_range(field, &low, &high);
    double steep = 0.5 * relief * texels / ((double)high - (double)low);
    for (int y = 0; y < side; y++)
        for (int x = 0; x < side; x++) {
            double sum = 0.0;
            for (int j = 0; j < step; j++)
                for (int i = 0; i < step; i++)
                    sum += light(field, x * step + i, y * step + j, steep);
            argb[y * side + x] = 0xff000000u | 0x010101u * code(sum / (step * step));
        }
}

#define STAMP_RELIEF 0.1    /* height range divided by the side */
#define TABLE_RELIEF 0.07   /* for tables */
#define TEXELS 512.0        /* approximate side of the table of a generator */
#define PLACED_TEXELS 192.0 /* for generators of one placed object */

/* The first cell of a picture, as it stands out of the ground, or is sunk into it. */
static bool print_stamp(const Item *item, int side, uint32_t *argb)
{
    WrError err;
    WrTipView view;
    int w, h, n = 2 * side;
    float low, high;
    WrTip *tip = wr_tip_read(item->stamp, &err);
    WrField *field =
        tip ? wr_field_new(n, n, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f, &err) : NULL;
    if (field) {
        wr_tip_size(tip, 0, &w, &h);
        double longer = w > h ? w : h, over = 1.0 - 4.0 / n; /* leaves a margin */
        wr_tip_view(tip, 0, n / longer, &view);
        for (int y = 0; y < n; y++)
            for (int x = 0; x < n; x++) {
                double s = ((x + 0.5) / n - 0.5) * longer / w / over + 0.5;
                double t = ((y + 0.5) / n - 0.5) * longer / h / over + 0.5;
                float up = wr_tip_value(&view, s, t);
                wr_field_set(field, x, y, item->lower ? -up : up);
            }
        wr_field_range(field, &low, &high);
        if (low < high) shade(field, STAMP_RELIEF, side, argb);
    }
    bool ok = field && low < high;
    wr_field_free(field);
    wr_tip_free(tip);
    return ok;
}

/* Run a line on a flat table, or on the result of `first`; NULL if the result is flat. */
static WrDocument *made(const Item *item, const char *first, int texels, WrPool *pool,
                        const WrProgress *progress)
{
    WrError err;
    WrText notes = { 0 };
    float low = 0.0f, high = 0.0f;
    WrField *level = wr_field_new(texels, texels, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f, &err);
    if (!level) return NULL;
    WrDocument *document = wr_document_new();
    wr_field_free(document->layers[0].heights);
    document->layers[0].heights = level;
    bool good = (!first || wr_edit_preview_generate(document, first, WR_LINE_INTO_ACTIVE, true,
                                                    pool, progress, &notes, &err)) &&
                wr_edit_preview_generate(document, item->line, WR_LINE_INTO_ACTIVE, true, pool,
                                         progress, &notes, &err);
    if (good) wr_field_range(document->layers[0].heights, &low, &high);
    wr_text_fini(&notes);
    if (good && low < high) return document;
    wr_document_free(document);
    return NULL;
}

static bool generate(const Item *item, int side, WrPool *pool, const WrProgress *progress,
                     uint32_t *argb)
{
    double step = floor((item->placed ? PLACED_TEXELS : TEXELS) / side + 0.5);
    int texels = side * (step > 1.0 ? (int)step : 1);
    WrDocument *document = made(item, NULL, texels, pool, progress);
    if (!document && item->ground) /* it may modify existing heights */
        document = made(item, item->ground, texels, pool, progress);
    if (!document) return false;
    shade(document->layers[0].heights, TABLE_RELIEF, side, argb);
    wr_document_free(document);
    return true;
}

/* The lines are cut apart. */
static bool render(char *lines, int side, WrPool *pool, uint32_t *argb)
{
    WrSession *session = wr_session_new(NULL);
    WrFrame frame;
    bool good = true;
    for (char *at = lines, *next; good && *at; at = next) {
        next = at + strcspn(at, "\n");
        if (*next) *next++ = '\0';
        good = wr_session_run(session, at, NULL);
    }
    good = good && wr_session_frame(session, side, side, 0, &frame, NULL);
    if (good) {
        /* over the background of fields */
        WrFrameCodes codes = wr_frame_codes_of(wr_session_document(session)->scene, true);
        codes.background = (WrBackground){ WR_BACKGROUND_PLAIN, { GROUND, GROUND, GROUND }, { 0 } };
        wr_frame_to_srgb8(&frame, &codes, true, (uint8_t *)argb, pool);
    }
    wr_session_free(session);
    return good;
}

static void make(Item *item, int side, WrPool *pool, const WrProgress *progress)
{
    WrError err;
    uint32_t *argb = wr_alloc((size_t)side * (size_t)side, sizeof *argb);
    WrImage *image = item->picture ? wr_image_read(item->picture, &err) : NULL;
    bool ok = image != NULL;
    if (image) shrink(image, side, argb);
    else if (item->stamp) ok = print_stamp(item, side, argb);
    else if (item->scene) ok = render(item->scene, side, pool, argb);
    else if (item->line) ok = generate(item, side, pool, progress, argb);
    else ok = paint(item, side, pool, argb);
    wr_image_free(image);
    if (ok) item->argb = argb;
    else wr_free(argb);
}

static void run(void *arg, WrPool *pool, const WrProgress *progress)
{
    Batch *batch = arg;
    for (int i = 0; i < batch->count && !wr_progress_cancelled(progress); i++)
        make(&batch->items[i], batch->side, pool, progress);
}

/* ---- on the window's thread ---- */

static void drop_wishes(WrThumbs *thumbs)
{
    for (int i = 0; i < thumbs->wishes.count; i++) drop_item(&thumbs->wishes.data[i]);
    thumbs->wishes.count = 0;
}

static void forget_kind(WrThumbs *thumbs, WrThumbKind kind)
{
    for (int i = (int)kind; i < thumbs->slots.count; i += WR_THUMB_KINDS) {
        Slot *slot = &thumbs->slots.data[i];
        if (slot->texture) SDL_DestroyTexture(slot->texture);
        *slot = (Slot){ 0 };
    }
    thumbs->round[kind]++;
}

static void forget_kinds(WrThumbs *thumbs, WrThumbKind first, WrThumbKind end)
{
    for (int kind = (int)first; kind < (int)end; kind++) forget_kind(thumbs, (WrThumbKind)kind);
    drop_wishes(thumbs);
}

static void thumbs_forget(WrApp *app)
{
    if (app->shelf->thumbs) forget_kinds(app->shelf->thumbs, 0, WR_THUMB_KINDS);
}

static WrThumbs *thumbs_of(WrApp *app)
{
    static const WrJobKind kind = { run, drop };
    WrThumbs *there = app->shelf->thumbs;
    if (there && there->of != app->shelf->serial) { /* another library */
        forget_kinds(there, 0, WR_THUMB_LISTS);
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

static char *copy_of(const char *text)
{
    return text ? wr_strdup(text) : NULL;
}

/* A smaller side reuses the textures (drawn smaller), so that dragging the width of the panel, or a list with large pictures
   beside a small button, does not load everything again. */
SDL_Texture *wr_thumb(WrApp *app, WrThumbKind kind, int index, int side, const WrThumbSource *of)
{
    WrThumbs *thumbs = thumbs_of(app);
    const int place = index * WR_THUMB_KINDS + (int)kind;
    side = side < 8 ? 8 : side > SIDE_MAX ? SIDE_MAX : side;
    if (side > thumbs->side[kind]) { /* another scale */
        forget_kind(thumbs, kind);
        thumbs->side[kind] = side;
    }
    while (thumbs->slots.count <= place) wr_array_push(&thumbs->slots, ((Slot){ 0 }));
    const Slot *slot = &thumbs->slots.data[place];
    if (!slot->texture && !slot->asked && !slot->failed)
        wr_array_push(&thumbs->wishes, ((Item){ .slot = place,
                                                .id = copy_of(of->id),
                                                .path = copy_of(of->path),
                                                .picture = copy_of(of->picture),
                                                .stamp = copy_of(of->stamp),
                                                .scene = copy_of(of->scene),
                                                .line = copy_of(of->line),
                                                .ground = copy_of(of->ground),
                                                .lower = of->lower,
                                                .placed = of->placed }));
    return slot->texture;
}

/* MyPaint's own pictures show colours, so its presets are painted. */
SDL_Texture *wr_thumb_of(WrApp *app, int index, int side)
{
    const WrLibrary *library = wr_preset_browser_library(app);
    WrThumbSource of = { 0 };
    if (index >= 0) {
        const WrPresetEntry *entry = wr_library_entry(library, index);
        of.id = entry->id;
        of.path = entry->path;
        of.picture = strncmp(entry->id, "mypaint", 7) == 0 ? NULL : entry->picture;
    }
    return wr_thumb(app, WR_THUMB_BRUSH, index + 1, side, &of);
}

/* Textures belong to the window's thread and are therefore created here, not in the job. A batch of an older round belongs to
   slots that were dropped since (other library, other scale); its results are freed unused. */
static void take(WrApp *app, Batch *batch)
{
    WrThumbs *thumbs = app->shelf->thumbs;
    for (int i = 0; i < batch->count && batch->round == thumbs->round[batch->kind]; i++) {
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

/* Wishes are those of the last frame only: a thumbnail that was scrolled out of view before its turn is not loaded.
   `asked` stays set after a failure, so a broken file is read once. A batch has one kind; generators and scenes are slow, so each
   has a batch of its own. */
static void ask(WrApp *app)
{
    WrThumbs *thumbs = app->shelf->thumbs;
    Batch *batch = wr_alloc(1, sizeof *batch);
    for (int i = 0; i < thumbs->wishes.count && batch->count < BATCH; i++) {
        Item *item = &thumbs->wishes.data[i];
        const WrThumbKind kind = (WrThumbKind)(item->slot % WR_THUMB_KINDS);
        const bool slow = item->line || item->scene, first = batch->count == 0;
        if (thumbs->slots.data[item->slot].asked || (!first && (slow || kind != batch->kind)))
            continue;
        thumbs->slots.data[item->slot].asked = true;
        batch->kind = kind;
        batch->items[batch->count++] = *item;
        *item = (Item){ 0 };
        if (slow) break;
    }
    batch->side = thumbs->side[batch->kind];
    batch->round = thumbs->round[batch->kind];
    wr_job_start(thumbs->job, batch);
}

void wr_thumbs_update(WrApp *app)
{
    WrThumbs *thumbs = app->shelf->thumbs ? thumbs_of(app) : NULL;
    if (!thumbs) return;
    Batch *done = wr_job_take(thumbs->job);
    if (done) take(app, done);
    if (thumbs->wishes.count > 0 && !wr_job_busy(thumbs->job, NULL, NULL)) ask(app);
    drop_wishes(thumbs);
}

const WrPart wr_part_thumbs = { .forget = thumbs_forget };
