#include "ui/toolkit/retained_frame.h"
#include "ui/toolkit/dirty_rects.h"

#include "base/array.h"
#include "base/hash.h"
#include "base/memory.h"

#include <SDL.h>
#include <string.h>

typedef enum Kind { FILL, COPY, POINTS, PIECE } Kind;

/* A frame is recorded first and drawn at its end. Each operation is hashed together with its place; the squares of the window
   (dirty_rects.c) accumulate the hashes of all operations that touch them, in order. A square whose sum equals that of the
   frame before has the same pixels, so only the other squares are drawn again and presented. This pays off only for SDL's
   software renderer, whose buffer keeps its pixels from frame to frame; with a graphics card the back buffer is undefined
   after presenting, so `damage` is NULL and every frame is drawn completely. */
/* A recorded operation. */
typedef struct Item {
    Kind kind;
    uint32_t argb;
    SDL_Rect box;     /* touches no pixel beyond */
    WrGuiPiece piece; /* piece of a command; of copies: `of` and `to` */
    int command;
    SDL_Texture *texture;
    int first, count; /* range of points */
} Item;

struct WrRetainedFrame {
    SDL_Renderer *renderer; /* borrowed */
    SDL_Window *window;     /* borrowed; NULL: the renderer draws to another target */
    WrDirtyRects *damage;   /* owned; NULL: every frame is drawn completely */
    int width, height;      /* pixels */
    volatile int lost;      /* atomic: the presented pixels may be lost */
    WR_ARRAY(Item) items;
    WR_ARRAY(WrGuiCommand) commands;
    WR_ARRAY(SDL_Point) points;
    WR_ARRAY(SDL_Rect) whole; /* boxes of scaled copies */
    WrGuiPen pen;
};

/* Events after which the system, or SDL, has lost the window's pixels. SDL calls watchers on the thread that produces the
   event, hence the atomic flag. The flag is set for all window events except those that are known to leave the pixels alone:
   a frame drawn too often is slow, a frame drawn too seldom is wrong. */
static int SDLCALL watch(void *ctx, SDL_Event *event)
{
    WrRetainedFrame *kept = ctx;
    const bool ours =
        event->type == SDL_WINDOWEVENT && event->window.windowID == SDL_GetWindowID(kept->window);
    if (ours) {
        switch (event->window.event) {
        case SDL_WINDOWEVENT_ENTER:
        case SDL_WINDOWEVENT_LEAVE:
        case SDL_WINDOWEVENT_FOCUS_GAINED:
        case SDL_WINDOWEVENT_FOCUS_LOST:
        case SDL_WINDOWEVENT_MOVED: break;
        default: __atomic_store_n(&kept->lost, 1, __ATOMIC_RELAXED); break;
        }
    }
    return 1;
}

WrRetainedFrame *wr_retained_frame_new(SDL_Renderer *renderer)
{
    WrRetainedFrame *kept = wr_alloc(1, sizeof *kept);
    SDL_RendererInfo info;
    const bool software =
        SDL_GetRendererInfo(renderer, &info) == 0 && (info.flags & SDL_RENDERER_SOFTWARE) != 0;
    kept->renderer = renderer;
    kept->window = SDL_RenderGetWindow(renderer);
    if (software) kept->damage = wr_dirty_rects_new();
    kept->pen.renderer = renderer;
    if (kept->window) SDL_AddEventWatch(watch, kept);
    return kept;
}

void wr_retained_frame_free(WrRetainedFrame *kept)
{
    if (!kept) return;
    if (kept->window) SDL_DelEventWatch(watch, kept);
    wr_dirty_rects_free(kept->damage);
    wr_array_free(&kept->items);
    wr_array_free(&kept->commands);
    wr_array_free(&kept->points);
    wr_array_free(&kept->whole);
    wr_free(kept);
}

SDL_Renderer *wr_retained_frame_renderer(const WrRetainedFrame *kept)
{
    return kept->renderer;
}

/* ---- recording ---- */

/* The words that are hashed for one operation; padding never enters, because only fields are copied. The longest entry is a
   textured triangle: kind, box (4), texture and revision (4) and three vertices. */
typedef struct Words {
    uint32_t word[32];
    int count;
} Words;
_Static_assert(9 * sizeof(uint32_t) + 3 * sizeof(WrGuiVertex) <= 32 * sizeof(uint32_t),
               "a textured triangle is longer than Words");

static void say(Words *words, uint32_t word)
{
    words->word[words->count++] = word;
}

static void print_rect(Words *words, const SDL_Rect *rect)
{
    memcpy(words->word + words->count, rect, sizeof *rect);
    words->count += 4;
}

/* The address alone is no identity: a texture can be freed and another created at the same address, or be written to. The
   revision (wr_gui_sdl_revision) changes with each of these. */
static void print_texture(Words *words, const SDL_Texture *texture, uintptr_t revision)
{
    const uint64_t both[2] = { (uint64_t)(uintptr_t)texture, revision };
    memcpy(words->word + words->count, both, sizeof both);
    words->count += 4;
}

static void note(WrRetainedFrame *kept, const Item *item, const Words *words)
{
    wr_array_push(&kept->items, *item);
    if (!kept->damage) return;
    const WrHash hash =
        wr_hash_bytes(words->word, (size_t)words->count * sizeof *words->word, (WrHash){ 0 });
    wr_dirty_rects_add(kept->damage, &item->box, hash.low);
}

static void empty(WrRetainedFrame *kept)
{
    kept->items.count = kept->commands.count = kept->points.count = kept->whole.count = 0;
}

void wr_retained_frame_drop(WrRetainedFrame *kept)
{
    empty(kept);
    if (kept->damage) wr_dirty_rects_forget(kept->damage);
}

void wr_retained_frame_clear(WrRetainedFrame *kept, uint32_t argb)
{
    SDL_GetRendererOutputSize(kept->renderer, &kept->width, &kept->height);
    empty(kept);
    if (kept->damage) wr_dirty_rects_begin(kept->damage, kept->width, kept->height);
    wr_retained_frame_fill(kept, &(SDL_Rect){ 0, 0, kept->width, kept->height }, argb);
}

void wr_retained_frame_fill(WrRetainedFrame *kept, const SDL_Rect *place, uint32_t argb)
{
    const Item item = { .kind = FILL, .argb = argb, .box = *place };
    Words words = { .count = 0 };
    say(&words, FILL);
    say(&words, argb);
    print_rect(&words, place);
    note(kept, &item, &words);
}

/* Tracked textures have revision 0 here: their owner reports the changed part with wr_retained_frame_changed, so a stroke on
   the canvas does not redraw the whole canvas. A scaled copy is different: clipping it to a part may shift the sampling
   positions by a rounding, so that seams would appear at the borders of the parts. Its box is in `whole`, and rectangles that
   touch it grow until they contain it. */
static void note_copy(WrRetainedFrame *kept, SDL_Texture *texture, const SDL_Rect *of,
                      const SDL_Rect *to, bool notifies)
{
    int w = 0, h = 0;
    uint8_t r, g, b, a;
    SDL_QueryTexture(texture, NULL, NULL, &w, &h);
    SDL_GetTextureColorMod(texture, &r, &g, &b);
    SDL_GetTextureAlphaMod(texture, &a);
    const SDL_Rect all = { 0, 0, w, h };
    const Item item = {
        .kind = COPY, .box = *to, .texture = texture, .piece = { .of = of ? *of : all, .to = *to }
    };
    const bool scaled = item.piece.of.w != to->w || item.piece.of.h != to->h;
    Words words = { .count = 0 };
    say(&words, COPY);
    say(&words, (uint32_t)a << 24 | (uint32_t)r << 16 | (uint32_t)g << 8 | b);
    print_texture(&words, texture, notifies && !scaled ? 0 : wr_gui_sdl_revision(texture));
    print_rect(&words, &item.piece.of);
    print_rect(&words, to);
    if (scaled) wr_array_push(&kept->whole, *to);
    note(kept, &item, &words);
}

void wr_retained_frame_copy(WrRetainedFrame *kept, SDL_Texture *texture, const SDL_Rect *of,
                            const SDL_Rect *to)
{
    note_copy(kept, texture, of, to, false);
}

void wr_retained_frame_copy_tracked(WrRetainedFrame *kept, SDL_Texture *texture, const SDL_Rect *of,
                                    const SDL_Rect *to)
{
    note_copy(kept, texture, of, to, true);
}

void wr_retained_frame_changed(WrRetainedFrame *kept, const SDL_Rect *place)
{
    if (kept->damage) wr_dirty_rects_touch(kept->damage, place);
}

/* Every point is hashed into its own square, not the enclosing box: an outline of moving dashes across the canvas would
   otherwise make the whole box dirty in each frame. */
void wr_retained_frame_points(WrRetainedFrame *kept, const SDL_Point *points, int count,
                              uint32_t argb)
{
    Item item = { .kind = POINTS, .argb = argb, .first = kept->points.count, .count = count };
    if (count <= 0 || !SDL_EnclosePoints(points, count, NULL, &item.box)) return;
    Words words = { .count = 0 };
    say(&words, POINTS);
    say(&words, argb);
    const WrHash colour = wr_hash_bytes(words.word, 2 * sizeof *words.word, (WrHash){ 0 });
    for (int i = 0; i < count; i++) {
        wr_array_push(&kept->points, points[i]);
        if (!kept->damage) continue;
        const SDL_Rect pixel = { points[i].x, points[i].y, 1, 1 };
        const WrHash hash = wr_hash_bytes(&points[i], sizeof points[i], colour);
        wr_dirty_rects_add(kept->damage, &pixel, hash.low);
    }
    wr_array_push(&kept->items, item);
}

static void note_piece(WrRetainedFrame *kept, const WrGuiCommand *command, const WrGuiPiece *piece)
{
    const bool plain = piece->kind == WR_GUI_PLAIN || piece->kind == WR_GUI_FILL;
    const Item item = {
        .kind = PIECE, .piece = *piece, .box = piece->box, .command = kept->commands.count - 1
    };
    Words words = { .count = 0 };
    if (piece->kind == WR_GUI_SCALED) wr_array_push(&kept->whole, piece->box);
    if (kept->damage) {
        say(&words, (uint32_t)PIECE << 8 | (uint32_t)piece->kind);
        print_rect(&words, &piece->box);
        if (!plain) print_texture(&words, command->texture, wr_gui_sdl_revision(command->texture));
        for (int k = 0; k < 3; k++) {
            const WrGuiVertex *at = &command->vertices[command->indices[piece->first + k]];
            memcpy(words.word + words.count, at, sizeof *at);
            words.count += (int)(sizeof *at / sizeof *words.word);
        }
    }
    note(kept, &item, &words);
}

void wr_retained_frame_command(WrRetainedFrame *kept, const WrGuiCommand *command)
{
    WrGuiCommand own = *command;
    SDL_QueryTexture(command->texture, NULL, NULL, &own.texture_w, &own.texture_h);
    wr_array_push(&kept->commands, own);
    for (int i = 0; i + 2 < own.index_count;) {
        const WrGuiPiece piece = wr_gui_sdl_piece(&own, i, kept->damage != NULL);
        if (piece.kind != WR_GUI_NOTHING) note_piece(kept, &own, &piece);
        i += piece.count;
    }
}

/* ---- drawing ---- */

static void draw_item(WrRetainedFrame *kept, const Item *item)
{
    if (item->kind != PIECE) wr_gui_sdl_flush(&kept->pen);
    switch (item->kind) {
    case FILL: wr_gui_sdl_fill(kept->renderer, &item->box, item->argb); break;
    case COPY:
        SDL_RenderCopy(kept->renderer, item->texture, &item->piece.of, &item->piece.to);
        break;
    case POINTS:
        SDL_SetRenderDrawColor(kept->renderer, (uint8_t)(item->argb >> 16),
                               (uint8_t)(item->argb >> 8), (uint8_t)item->argb,
                               (uint8_t)(item->argb >> 24));
        SDL_RenderDrawPoints(kept->renderer, kept->points.data + item->first, item->count);
        break;
    case PIECE: {
        const WrGuiCommand *command = &kept->commands.data[item->command];
        wr_gui_sdl_piece_draw(&kept->pen, command, &item->piece);
        break;
    }
    }
}

/* Draw all operations that touch a rectangle, clipped to it. The order of recording is the order of drawing, also for pieces
   that are only partly inside: blended pieces depend on it. The pen collects adjacent pieces of one state, so it must be
   flushed before each change of the clip rectangle and before operations that bypass it. */
static void draw_within(WrRetainedFrame *kept, const SDL_Rect *room)
{
    SDL_Rect clip = *room;
    SDL_RenderSetClipRect(kept->renderer, &clip);
    for (int i = 0; i < kept->items.count; i++) {
        const Item *item = &kept->items.data[i];
        SDL_Rect own = *room;
        if (!SDL_HasIntersection(&item->box, room)) continue;
        if (item->kind == PIECE)
            SDL_IntersectRect(&kept->commands.data[item->command].clip, room, &own);
        if (!SDL_RectEquals(&own, &clip)) {
            wr_gui_sdl_flush(&kept->pen);
            clip = own;
            SDL_RenderSetClipRect(kept->renderer, &clip);
        }
        draw_item(kept, item);
    }
    wr_gui_sdl_flush(&kept->pen);
    SDL_RenderSetClipRect(kept->renderer, NULL);
}

/* Present only the drawn rectangles, if SDL supports that. */
static void put(WrRetainedFrame *kept, const SDL_Rect *rects, int count)
{
    SDL_RenderFlush(kept->renderer);
    if (!kept->window || !kept->damage ||
        SDL_UpdateWindowSurfaceRects(kept->window, rects, count) != 0)
        SDL_RenderPresent(kept->renderer);
}

void wr_retained_frame_end(WrRetainedFrame *kept)
{
    SDL_Rect rects[WR_DIRTY_RECTS_MAX] = { { 0, 0, kept->width, kept->height } };
    int count = 1;
    const bool lost = __atomic_exchange_n(&kept->lost, 0, __ATOMIC_RELAXED) != 0;
    if (lost && kept->damage) wr_dirty_rects_forget(kept->damage);
    if (kept->damage)
        count = wr_dirty_rects_end(kept->damage, kept->whole.data, kept->whole.count, rects);
    for (int i = 0; i < count; i++) draw_within(kept, &rects[i]);
    if (count > 0) put(kept, rects, count);
}

void wr_retained_frame_draw_whole(WrRetainedFrame *kept)
{
    const SDL_Rect all = { 0, 0, kept->width, kept->height };
    draw_within(kept, &all);
    put(kept, &all, 1);
}
