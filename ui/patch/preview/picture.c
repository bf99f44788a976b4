#include "ui/patch/preview/picture.h"
#include "ui/patch/preview/preview.h"
#include "ui/toolkit/words.h"
#include "ui/patch/preview/overexposure.h"

#include "base/enum_rows.h"
#include "base/error.h"
#include "base/memory.h"
#include "image/image.h"
#include "render/frame/frame.h"
#include "render/plan/effect_heatmap.h"
#include "scene/scene.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- heat map of an effect ---- */

static bool make_room(WrPictureRan *ran, int width, int height, WrError *err)
{
    if (ran->map && ran->width == width && ran->height == height) return true;
    wr_free(ran->map);
    ran->map = wr_try_alloc((size_t)width * (size_t)height, 1, "the preview", err);
    ran->width = width;
    ran->height = height;
    return ran->map != NULL;
}

bool wr_picture_heatmap_update(WrPictureRan *ran, WrFrameRequest *request, WrError *err)
{
    if (!make_room(ran, request->width, request->height, err)) return false;
    request->map = ran->map;
    return true;
}

/* Write the colours to the picture's pixels, of the same size, and its counts. */
static void picture_ran_show(const WrPictureRan *ran, WrPreviewPicture *out)
{
    const size_t pixels = (size_t)ran->width * (size_t)ran->height;
    uint8_t rgb[256][3], bgra[256][4];
    wr_heatmap_count(ran->map, pixels, &out->counts);
    wr_heatmap_colours(&out->counts, rgb);
    for (int b = 0; b < 256; b++) {
        for (int c = 0; c < 3; c++) bgra[b][c] = rgb[b][2 - c];
        bgra[b][3] = 255;
    }
    for (size_t i = 0; i < pixels; i++) memcpy(out->bgra + 4 * i, bgra[ran->map[i]], 4);
}

/* ---- time of the newest patch picture ---- */

/* One figure for all places that show it. */

const char *const wr_picture_stages[] = { "prepare", "visibility", "geometry",
                                          "bump",    "shade",      "resolve" };
_Static_assert(WR_LENGTH(wr_picture_stages) == WR_PICTURE_STAGES, "preview.h counts them");
_Static_assert(sizeof(WrStageTimes) == (WR_PICTURE_STAGES + 2) * sizeof(double),
               "each has its time, beside total and pyramid");

double wr_picture_time(const WrPreviewPicture *picture, double ms[WR_PICTURE_STAGES])
{
    const WrStageTimes *t = &picture->times;
    const double spent[WR_PICTURE_STAGES] = { t->prepare, t->visibility, t->geometry,
                                              t->bump,    t->shade,      t->resolve };
    double all = 0.0, total = picture->seconds * 1e3;
    for (int i = 0; i < WR_PICTURE_STAGES; i++) all += spent[i];
    /* Threads run in parallel, so the sum of their times exceeds wall time; scale it. */
    for (int i = 0; i < WR_PICTURE_STAGES; i++) ms[i] = all > 0.0 ? total * spent[i] / all : 0.0;
    return total;
}

void wr_picture_moving(const WrPreviewPicture *picture, char text[WR_PICTURE_MOVING])
{
    text[0] = '\0';
    if (picture->level != WR_PREVIEW_MOVING) return;
    const int used =
        snprintf(text, WR_PICTURE_MOVING, "%s", wr_words(wr_moving_names[picture->way]));
    if (picture->scale < 1)
        snprintf(text + used, WR_PICTURE_MOVING - (size_t)used, wr_words(" at %.0f %%"),
                 100 * picture->scale);
}

void wr_picture_words(const WrPreviewPicture *picture, char text[WR_PICTURE_WORDS])
{
    WR_ROWS(how);
    static const char *const how[WR_PREVIEW_LEVELS] = {
        [WR_ROW(WR_PREVIEW_NONE)] = "",
        [WR_ROW(WR_PREVIEW_MOVING)] = ", while something moves",
        [WR_ROW(WR_PREVIEW_FULL)] = ", each looked at once",
        [WR_ROW(WR_PREVIEW_SMOOTH)] = ", 2 \xc3\x97 2 samples each",
        [WR_ROW(WR_PREVIEW_FINAL)] = ", as fine as it gets"
    };
    WR_ROWS_END(how, WR_PREVIEW_LEVELS);
    char way[WR_PICTURE_MOVING], moving[WR_PICTURE_MOVING + 4] = "";
    double ms[WR_PICTURE_STAGES], total = wr_picture_time(picture, ms);
    wr_picture_moving(picture, way);
    if (way[0]) snprintf(moving, sizeof moving, wr_words(": %s"), way);
    wr_words_print(
        text, WR_PICTURE_WORDS,
        wr_words(
            "%.1f ms by the clock for the newest picture of the patch, conversion for the screen "
            "included: %d \xc3\x97 %d pixels%s%s."),
        total, picture->width, picture->height, wr_words(how[picture->level]), moving);
}

/* ---- checkerboard behind transparency ---- */

#define SQUARE 8.0 /* pixels of the window */

static const float greys[2] = { 0.32f, 0.13f }; /* linear; 8-bit values 155 and 101 */

/* Composite a tone-mapped premultiplied colour over a display grey. */
static void put(const float *from, float grey, const WrTone *tone, uint8_t *to)
{
    float own[3] = { 0 };
    for (int c = 0; c < 3 && from[3] > 0.0f; c++) own[c] = from[c] / from[3];
    if (from[3] > 0.0f) wr_tone_colour(tone, own);
    for (int c = 0; c < 3; c++) {
        const float sum = from[3] * own[c] + (1.0f - from[3]) * grey;
        const float code = wr_srgb_encode(fminf(fmaxf(sum, 0.0f), 1.0f));
        to[2 - c] = (uint8_t)(code * 255.0f + 0.5f);
    }
    to[3] = 255;
}

/* Composite a float picture over a checkerboard into 8-bit pixels [height][width] B,G,R,A. scale: picture pixels per
 * window pixel; a square is 8 window pixels wide. Fully covered pixels keep their values. */
static void chequer_behind(const WrFrame *frame, const WrTone *tone, double scale, uint8_t *bgra)
{
    static const float nothing[4] = { 0, 0, 0, 0 };
    const double side = fmax(1.0, SQUARE * scale);
    uint8_t bare[2][4]; /* uncovered pixels, which are the majority */
    for (int k = 0; k < 2; k++) put(nothing, greys[k], tone, bare[k]);
    for (int y = 0; y < frame->height; y++) {
        const int row = (int)(y / side);
        for (int x = 0; x < frame->width; x++) {
            const size_t at = 4 * ((size_t)y * (size_t)frame->width + (size_t)x);
            const float *from = frame->rgba + at;
            if (!(from[3] < 1.0f)) continue;
            const int which = (row + (int)(x / side)) & 1;
            if (from[3] > 0.0f) put(from, greys[which], tone, bgra + at);
            else memcpy(bgra + at, bare[which], 4);
        }
    }
}

/* ---- upload of a picture ---- */

bool wr_preview_look_same(const WrPreviewLook *a, const WrPreviewLook *b)
{
    return a->ran == b->ran && a->marked == b->marked && a->force == b->force &&
           (!a->force || a->effect == b->effect);
}

void wr_picture_put(WrPreviewPicture *picture, const WrFrame *frame, const WrFrameRequest *request,
                    const WrPreviewLook *look, double scale, const WrPictureRan *ran, WrPool *pool)
{
    const size_t pixels = (size_t)frame->width * (size_t)frame->height;
    picture->clipped = 0;
    if (look->ran) {
        picture_ran_show(ran, picture);
        return;
    }
    if (frame->codes) memcpy(picture->bgra, frame->codes, 4 * pixels);
    else wr_frame_to_srgb8(frame, &request->codes, true, picture->bgra, pool);
    if (!request->codes.wanted && frame->rgba)
        chequer_behind(frame, &request->scene->tone, scale, picture->bgra);
    picture->clipped = wr_overexposed(picture->bgra, frame->width, frame->height, look->marked);
}

/* ---- pixels of a picture ---- */

void wr_picture_free(WrPreviewPicture *picture)
{
    if (picture) wr_free(picture->bgra);
    if (picture) wr_free(picture->kept);
    wr_free(picture);
}

bool wr_picture_room(WrPreviewPicture *picture, int width, int height, WrError *err)
{
    if (picture->bgra && picture->width == width && picture->height == height) return true;
    uint8_t *bgra = wr_try_alloc((size_t)width * (size_t)height, 4, "the preview", err);
    if (!bgra) return false;
    wr_free(picture->bgra);
    picture->bgra = bgra;
    picture->width = width;
    picture->height = height;
    return true;
}

static const uint8_t *row_of(const WrPreviewPicture *picture, int y)
{
    return picture->bgra + 4 * (size_t)picture->width * (size_t)y;
}

/* The first differing pixel of a row before `most`; and the last one after `least`. */
static int first_other(const uint8_t *a, const uint8_t *b, int most)
{
    int x = 0;
    while (x < most && memcmp(a + 4 * x, b + 4 * x, 4) == 0) x++;
    return x;
}

static int last_other(const uint8_t *a, const uint8_t *b, int width, int least)
{
    int x = width - 1;
    while (x > least && memcmp(a + 4 * x, b + 4 * x, 4) == 0) x--;
    return x;
}

void wr_picture_compare(WrPreviewPicture *picture, const WrPreviewPicture *before)
{
    const int width = picture->width, height = picture->height;
    int left = width, right = -1, top = height, bottom = -1;
    picture->changed = (SDL_Rect){ 0, 0, width, height };
    picture->since = 0;
    if (!before || before->width != width || before->height != height) return;
    for (int y = 0; y < height; y++) {
        const uint8_t *a = row_of(picture, y), *b = row_of(before, y);
        if (memcmp(a, b, 4 * (size_t)width) == 0) continue;
        left = first_other(a, b, left);
        right = last_other(a, b, width, right);
        if (top > y) top = y;
        bottom = y;
    }
    picture->since = before->serial;
    picture->changed = bottom < 0 ? (SDL_Rect){ 0, 0, 0, 0 }
                                  : (SDL_Rect){ left, top, right + 1 - left, bottom + 1 - top };
}

void wr_picture_follow(WrPreviewPicture *picture, const WrPreviewPicture *missed)
{
    if (picture->since != missed->serial) return;
    SDL_UnionRect(&picture->changed, &missed->changed, &picture->changed);
    picture->since = missed->since;
}
