/* Retained frame of the window: after any change, the partially drawn frame is pixel-identical to a completely drawn
   one. */
#include "test.h"
#include "app.h"

#include "ui/app/app.h"
#include "ui/app/state/action.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/layout.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/settings.h"
#include "ui/toolkit/dirty_rects.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/retained_frame.h"

/* ---- rectangles ---- */

/* Dirty squares by definition: those with another list of operations. */
typedef struct Square {
    uint64_t list[8];
    int count;
} Square;

#define ACROSS 11 /* squares of 32 pixels; the frame ends inside the last ones */
#define DOWN 7
#define WIDE 341
#define TALL 203

static void note(Square *squares, const SDL_Rect *box, uint64_t what)
{
    for (int y = 0; y < DOWN; y++)
        for (int x = 0; x < ACROSS; x++) {
            Square *s = &squares[y * ACROSS + x];
            const SDL_Rect room = { 0, 0, WIDE, TALL }, square = { 32 * x, 32 * y, 32, 32 };
            SDL_Rect at;
            SDL_IntersectRect(&square, &room, &at);
            if (SDL_HasIntersection(box, &at)) s->list[s->count++] = what;
        }
}

static bool covers(const SDL_Rect *rects, int count, int x, int y)
{
    for (int i = 0; i < count; i++)
        if (x >= rects[i].x && x < rects[i].x + rects[i].w && y >= rects[i].y &&
            y < rects[i].y + rects[i].h)
            return true;
    return false;
}

static SDL_Rect some_box(TestRandom *r)
{
    return (SDL_Rect){ (int)(400 * test_random(r)) - 40, (int)(260 * test_random(r)) - 30,
                       1 + (int)(90 * test_random(r)), 1 + (int)(70 * test_random(r)) };
}

static void what_changed_is_covered_by_rectangles_that_do_not_overlap(void **state)
{
    (void)state;
    TestRandom r = { 61 };
    static Square before[DOWN * ACROSS], now[DOWN * ACROSS];
    WrDirtyRects *damage = wr_dirty_rects_new();
    int none = 0, few = 0;
    for (int k = 0; k < 400; k++) {
        SDL_Rect rects[WR_DIRTY_RECTS_MAX], whole[2] = { some_box(&r), some_box(&r) };
        const SDL_Rect touched = some_box(&r), room = { 0, 0, WIDE, TALL };
        const bool touch = k % 5 == 4;
        memset(now, 0, sizeof now);
        wr_dirty_rects_begin(damage, WIDE, TALL);
        /* Operations that are mostly those of the previous frame. */
        TestRandom same = { 7 + (uint64_t)(k / 4) };
        for (int i = 0; i < 5; i++) {
            const SDL_Rect box = some_box(k % 4 == 1 && i == 4 ? &r : &same);
            const uint64_t what = (uint64_t)box.x * 1009 + (uint64_t)box.y;
            wr_dirty_rects_add(damage, &box, what);
            note(now, &box, what);
        }
        if (touch) wr_dirty_rects_touch(damage, &touched);
        const int count = wr_dirty_rects_end(damage, whole, 2, rects);
        assert_true(count >= 0 && count <= WR_DIRTY_RECTS_MAX);
        if (k == 0) assert_true(count == 1 && SDL_RectEquals(&rects[0], &room));
        none += count == 0;
        few += count > 1;
        for (int y = k % 5; y < TALL; y += 5)
            for (int x = k % 7; x < WIDE; x += 7) {
                const Square *a = &before[y / 32 * ACROSS + x / 32];
                const Square *b = &now[y / 32 * ACROSS + x / 32];
                const SDL_Point pixel = { x, y };
                const bool must = a->count != b->count ||
                                  memcmp(a->list, b->list, sizeof a->list) != 0 ||
                                  (touch && SDL_PointInRect(&pixel, &touched));
                if (must && !covers(rects, count, x, y)) fail_msg("picture %d: %d %d", k, x, y);
            }
        for (int i = 0; i < count; i++) {
            for (int j = 0; j < i; j++) assert_false(SDL_HasIntersection(&rects[i], &rects[j]));
            for (int j = 0; j < 2; j++) {
                SDL_Rect seen, both;
                if (!SDL_IntersectRect(&whole[j], &room, &seen)) continue;
                if (!SDL_IntersectRect(&seen, &rects[i], &both)) continue;
                assert_true(SDL_RectEquals(&seen, &both));
            }
        }
        memcpy(before, now, sizeof now);
    }
    SDL_Rect rects[WR_DIRTY_RECTS_MAX], all = { 0, 0, 99, 55 };
    wr_dirty_rects_begin(damage, 99, 55);
    assert_int_equal(wr_dirty_rects_end(damage, NULL, 0, rects), 1);
    assert_true(SDL_RectEquals(&rects[0], &all));
    assert_true(none > 50 && few > 20); /* unchanged frames; several changed places at once */
    wr_dirty_rects_free(damage);
}

/* ---- one thing changed ---- */

#define SHAPES 24 /* four vertices and two triangles each */
#define PIXELS 16 /* of a texture's side */

typedef struct Drawing {
    SDL_Surface *surface;
    SDL_Renderer *renderer;
    WrRetainedFrame *kept;
    SDL_Texture *letters, *picture;
    WrGuiVertex vertices[4 * SHAPES];
    uint16_t indices[6 * SHAPES];
    SDL_Rect clip[2], fill, copy;
    SDL_Point points[5];
    uint32_t argb;
} Drawing;

static SDL_Color some_colour(TestRandom *r)
{
    const uint32_t x = (uint32_t)(16777216 * test_random(r));
    return (SDL_Color){ (uint8_t)x, (uint8_t)(x >> 8), (uint8_t)(x >> 16),
                        (uint8_t)(test_random(r) < 0.5 ? 255 : 256 * test_random(r)) };
}

static void some_pixels(TestRandom *r, SDL_Texture *texture)
{
    uint32_t pixels[PIXELS * PIXELS];
    for (int i = 0; i < PIXELS * PIXELS; i++) pixels[i] = (uint32_t)(4294967296 * test_random(r));
    pixels[0] = 0xffffffffu; /* the white texel */
    wr_gui_sdl_update(texture, NULL, pixels, 4 * PIXELS);
}

/* In turn: a rectangle without texture, a letter, a scaled picture, any two triangles, and two that form a rectangle
   starting at its last corner. */
static void some_shape(TestRandom *r, Drawing *d, int i)
{
    WrGuiVertex *at = &d->vertices[4 * i];
    const float x = (float)(300 * test_random(r)), y = (float)(190 * test_random(r));
    const int from = 1 + (int)(6 * test_random(r)), size = 2 + (int)(8 * test_random(r));
    const float grown = i % 4 == 1 ? 1 : (float)(0.3 + 3 * test_random(r));
    const SDL_Color colour = some_colour(r);
    for (int k = 0; k < 4; k++) {
        const int right = k == 1 || k == 2, down = k > 1;
        at[k] = (WrGuiVertex){ x + (float)(right * size) * grown, y + (float)(down * size) * grown,
                               (float)(from + right * size) / PIXELS,
                               (float)(from + down * size) / PIXELS, colour };
        if (i % 4 == 0 || i % 8 == 7) at[k].u = at[k].v = 0;
        if (i % 8 == 7) at[k].x = x - 57.6f * (float)right, at[k].y = y - 61.3f * (float)down;
        if (i % 8 != 3) continue;
        at[k].x += (float)(30 * test_random(r));
        at[k].y += (float)(30 * test_random(r));
        at[k].colour = some_colour(r);
    }
}

static void draw(Drawing *d)
{
    wr_retained_frame_clear(d->kept, 0xff305070u);
    wr_retained_frame_fill(d->kept, &d->fill, d->argb);
    wr_retained_frame_copy(d->kept, d->picture, NULL, &d->copy);
    wr_retained_frame_points(d->kept, d->points, 5, d->argb);
    for (int half = 0; half < 2; half++)
        wr_retained_frame_command(d->kept,
                                  &(WrGuiCommand){ .texture = half ? d->picture : d->letters,
                                                   .vertices = d->vertices,
                                                   .indices = d->indices + half * 3 * SHAPES,
                                                   .index_count = 3 * SHAPES,
                                                   .clip = d->clip[half] });
    wr_retained_frame_end(d->kept);
}

/* Change one operation. */
static void change(TestRandom *r, Drawing *d)
{
    WrGuiVertex *at = &d->vertices[(int)(4 * SHAPES * test_random(r))];
    switch ((int)(11 * test_random(r))) {
    case 0: at->colour = some_colour(r); break;
    case 1: at->colour.a ^= 1 + (uint8_t)(200 * test_random(r)); break;
    case 2: at->x += 3; break;
    case 3: some_shape(r, d, (int)(SHAPES * test_random(r))); break;
    case 4: some_pixels(r, test_random(r) < 0.5 ? d->letters : d->picture); break;
    case 5:
        d->clip[(int)(2 * test_random(r))] =
            (SDL_Rect){ (int)(60 * test_random(r)), (int)(50 * test_random(r)),
                        200 + (int)(70 * test_random(r)), 130 + (int)(50 * test_random(r)) };
        break;
    case 6: d->points[(int)(5 * test_random(r))].x += 1; break;
    case 7: d->argb ^= (uint32_t)(16777216 * test_random(r)); break;
    case 8: d->fill.w += 2; break;
    case 9: { /* the topmost moves to the bottom */
        WrGuiVertex held[4], *other = &d->vertices[4 * (int)(SHAPES * test_random(r))];
        at = &d->vertices[4 * (int)(SHAPES * test_random(r))];
        memcpy(held, at, sizeof held);
        memcpy(at, other, sizeof held);
        memcpy(other, held, sizeof held);
        break;
    }
    default: d->copy.x += test_random(r) < 0.5 ? 1 : -1;
    }
}

static void whatever_changes_in_a_picture_is_drawn(void **state)
{
    (void)state;
    TestRandom r = { 67 };
    static Drawing d;
    d.surface = SDL_CreateRGBSurfaceWithFormat(0, 341, 203, 32, SDL_PIXELFORMAT_RGB888);
    d.renderer = SDL_CreateSoftwareRenderer(d.surface);
    assert_non_null(d.renderer);
    d.kept = wr_retained_frame_new(d.renderer);
    SDL_Texture **textures[2] = { &d.letters, &d.picture };
    for (int k = 0; k < 2; k++) {
        *textures[k] = SDL_CreateTexture(d.renderer, SDL_PIXELFORMAT_ABGR8888,
                                         SDL_TEXTUREACCESS_STATIC, PIXELS, PIXELS);
        SDL_SetTextureBlendMode(*textures[k], SDL_BLENDMODE_BLEND);
        SDL_SetTextureScaleMode(*textures[k], SDL_ScaleModeLinear);
        some_pixels(&r, *textures[k]);
        d.clip[k] = (SDL_Rect){ 10, 10, 300, 180 };
    }
    for (int i = 0; i < SHAPES; i++) {
        static const uint16_t two[6] = { 0, 1, 2, 0, 2, 3 };
        some_shape(&r, &d, i);
        for (int k = 0; k < 6; k++) d.indices[6 * i + k] = (uint16_t)(4 * i + two[k]);
    }
    for (int i = 0; i < 5; i++) d.points[i] = (SDL_Point){ 30 + 3 * i, 40 + i };
    d.fill = some_box(&r), d.copy = (SDL_Rect){ 200, 120, 41, 27 }, d.argb = 0x80ff8020u;
    const size_t bytes = (size_t)d.surface->pitch * (size_t)d.surface->h;
    uint8_t *kept = malloc(bytes);
    for (int i = 0; i < 600; i++) {
        if (i > 0) change(&r, &d);
        draw(&d);
        memcpy(kept, d.surface->pixels, bytes);
        wr_retained_frame_draw_whole(d.kept);
        if (memcmp(kept, d.surface->pixels, bytes) != 0) fail_msg("picture %d", i);
    }
    free(kept);
    wr_retained_frame_free(d.kept);
    SDL_DestroyRenderer(d.renderer);
    SDL_FreeSurface(d.surface);
}

/* ---- the window ---- */

static struct {
    uint32_t *partial, *whole;
    int width, height, pictures;
    int differed; /* frames that differ from the previous one */
    const char *doing;
} seen;

static void read_pixels(WrApp *app, uint32_t *pixels)
{
    assert_int_equal(
        SDL_RenderReadPixels(app->renderer, NULL, SDL_PIXELFORMAT_RGB888, pixels, 4 * seen.width),
        0);
}

/* Called after each frame. */
static void compare(WrApp *app)
{
    int w, h;
    SDL_GetRendererOutputSize(app->renderer, &w, &h);
    if (w != seen.width || h != seen.height) {
        seen.width = w;
        seen.height = h;
        free(seen.partial);
        free(seen.whole);
        seen.partial = calloc((size_t)w * (size_t)h, 4);
        seen.whole = calloc((size_t)w * (size_t)h, 4);
    }
    const size_t count = (size_t)w * (size_t)h;
    read_pixels(app, seen.partial);
    seen.differed += memcmp(seen.partial, seen.whole, 4 * count) != 0;
    wr_retained_frame_draw_whole(wr_gui_kept(app->gui));
    read_pixels(app, seen.whole);
    const bool same = memcmp(seen.partial, seen.whole, 4 * count) == 0;
    for (size_t i = 0; !same && i < count; i++)
        if ((seen.partial[i] ^ seen.whole[i]) & 0xffffff)
            fail_msg("%s, picture %d: the pixel at %d %d is %06x, not %06x", seen.doing,
                     seen.pictures, (int)i % w, (int)i / w, seen.partial[i], seen.whole[i]);
    seen.pictures++;
}

static void step(WrApp *app)
{
    app->drawn_at -= 1; /* independent of the clock */
    SDL_PushEvent(&(SDL_Event){ .type = app->ready_event });
    wr_app_step(app);
}

static int within(TestRandom *r, int low, int size)
{
    return low + (int)((0.05 + 0.9 * test_random(r)) * size);
}

/* Move the pointer over a part of the window, pressed or not. */
static void drag(WrApp *app, TestRandom *r, const SDL_Rect *room, int which)
{
    int x = within(r, room->x, room->w), y = within(r, room->y, room->h);
    push_motion(app, x, y);
    if (which) push_button(app, true, which, x, y);
    for (int i = 0; i < 4; i++) {
        x += (int)(40 * test_random(r)) - 20;
        y += (int)(40 * test_random(r)) - 20;
        push_motion(app, x, y);
        step(app);
    }
    if (which) push_button(app, false, which, x, y);
    step(app);
}

static void act(WrApp *app, const char *name)
{
    seen.doing = name;
    wr_action_run(app, name);
    for (int i = 0; i < 2; i++) step(app);
}

static void dialogs(WrApp *app, TestRandom *r)
{
    static const char *const names[] = { "preferences", "new",    "search", "adjust_blur",
                                         "table_size",  "export", "help",   "maps" };
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        act(app, names[i]);
        push_motion(app, within(r, 0, app->width), within(r, 0, app->height));
        step(app);
        if (app->dialog->now != WR_DIALOG_NONE) wr_dialog_close(app);
        step(app);
    }
}

static void hands(WrApp *app, TestRandom *r)
{
    const SDL_Rect all = { 0, 0, app->width, app->height };
    const SDL_Rect menu = { 0, 0, app->width / 2, 20 };
    seen.doing = "painting";
    app->settings->brush.radius = 1 + 12 * test_random(r);
    for (int i = 0; i < 2; i++) drag(app, r, &app->layout->canvas, SDL_BUTTON_LEFT);
    seen.doing = "hovering";
    drag(app, r, &all, 0);
    drag(app, r, &app->layout->panel, 0);
    seen.doing = "a panel";
    drag(app, r, &app->layout->panel, SDL_BUTTON_LEFT);
    seen.doing = "the patch";
    drag(app, r, &app->layout->patch, SDL_BUTTON_LEFT);
    drag(app, r, &app->layout->patch, SDL_BUTTON_RIGHT);
    seen.doing = "the canvas, moved";
    drag(app, r, &app->layout->canvas, SDL_BUTTON_MIDDLE);
    seen.doing = "a menu";
    drag(app, r, &menu, SDL_BUTTON_LEFT);
    SDL_PushEvent(&(SDL_Event){
        .key = { .type = SDL_KEYDOWN,
                 .state = SDL_PRESSED,
                 .keysym = { .scancode = SDL_SCANCODE_ESCAPE, .sym = SDLK_ESCAPE } } });
    step(app);
}

static void the_picture_that_is_kept_has_the_pixels_of_one_drawn_whole(void **state)
{
    (void)state;
    static const char *const tools[] = { "undo", "select_all", "layer_add", "turn", "redo" };
    TestRandom r = { 20 };
    Bench bench;
    begin(&bench);
    WrApp *app = bench.app;
    wr_app_run_line(app, "surface sphere");
    SDL_SetWindowSize(app->window, 701, 487);
    app->drawn = compare;
    seen.doing = "the beginning";
    for (int i = 0; i < 5; i++) {
        if (i == 1) app->settings->theme = (app->settings->theme + 1) % 3;
        if (i == 2) wr_app_set_scale(app, 1.37);
        if (i == 3) SDL_SetWindowSize(app->window, 643, 533);
        hands(app, &r);
        act(app, tools[i]);
        seen.doing = "a tab";
        app->settings->tab = (i + 1) % app->registry->tab_count;
        step(app);
        seen.doing = "a line";
        wr_app_run_line(app, i % 2 ? "pattern bricks" : "adjust offset du=13 dv=5");
        step(app);
    }
    dialogs(app, &r);
    assert_true(seen.pictures > 100);
    assert_true(seen.differed > 80);
    finish(&bench);
    free(seen.partial);
    free(seen.whole);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_changed_is_covered_by_rectangles_that_do_not_overlap),
        cmocka_unit_test(whatever_changes_in_a_picture_is_drawn),
        cmocka_unit_test(the_picture_that_is_kept_has_the_pixels_of_one_drawn_whole),
    };
    return cmocka_run_group_tests(tests, enter_window, remove_folder);
}
