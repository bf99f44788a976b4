#include "ui/patch/preview/preview.h"
#include "ui/patch/preview/picture.h"
#include "ui/app/jobs/job.h"

#include "accuracy/tolerance.h"
#include "base/array.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/text.h"
#include "command/session.h"
#include "document/object_tables.h"
#include "field/field.h"
#include "field/scheme.h"
#include "render/frame/frame.h"
#include "scene/dials.h"
#include "scene/objects.h"
#include "scene/scene.h"
#include "shade/bump.h"
#include "system/clock.h"
#include "system/thread.h"

#include <SDL.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define MOVING_SECONDS 0.016 /* time limit of a moving picture */
#define QUICK_SECONDS 0.005  /* time limit while painting: visible within 1/60 s */
#define EDIT_SECONDS                                                                               \
    0.012 /* time limit of an update after an edit; beyond it fewer samples are used */

typedef struct Wish {
    WrField *field; /* shared, owned; NULL: no request */
    WrTables *tables;
    WrScene *scene;
    double turn_deg;
    int width, height;
    int64_t tag;
    char *chosen; /* owned */
    bool moving, painting;
    WrPreviewLook look;
} Wish;

struct WrPreview {
    WrMutex lock; /* protects the members up to the next blank line */
    WrCond wake;
    bool started, quit;
    Wish next; /* not started yet */
    bool settled;
    double point_x, point_y;   /* requested */
    bool point_new, point_hit; /* not looked up yet; on the object */
    double point_u, point_v;
    WrPreviewPicture *done, *shown; /* owned */
    bool fresh;                     /* `done` is newer than `shown` */
    bool failed;
    WrError error;

    volatile int cancel; /* atomic; read by the renderer */
    WrThread thread;
    int threads;
    char *isa; /* owned */
    Uint32 ready_event;

    /* used only by the thread, or by the window's if there is none */
    WrPool *pool;         /* owned, as is the renderer */
    WrRenderer *renderer; /* NULL: not created yet, or failed */
    Wish now;
    WrPreviewPicture *work;         /* owned */
    const WrPreviewPicture *newest; /* the one of these two finished last; NULL: none yet */
    WrPreviewLevel level;           /* reached for `now` */
    WrMoving moving;
    WrPictureRan ran; /* of the last effect heatmap */
    WrChoice choice;  /* of the last picture under a tolerance */
    /* time of the last update after an edit with more than one sample per pixel */
    double edit_seconds;
    bool edited; /* the running picture is such an update */
    uint64_t serial;
    int last_width, last_height; /* of the last picture */
};

static void request_clear(Wish *wish)
{
    wr_field_free(wish->field);
    wr_tables_free(wish->tables);
    if (wish->scene) wr_scene_free(wish->scene);
    wr_free(wish->chosen);
    *wish = (Wish){ 0 };
}

WrPreview *wr_preview_new(int threads, const char *isa, Uint32 ready_event)
{
    WrPreview *preview = wr_alloc(1, sizeof *preview);
    wr_mutex_init(&preview->lock);
    wr_cond_init(&preview->wake);
    preview->threads = threads;
    preview->isa = wr_strdup(isa);
    preview->ready_event = ready_event;
    preview->moving.scale = 0.4;
    preview->point_x = -1.0;
    preview->settled = true;
    preview->done = wr_alloc(1, sizeof(WrPreviewPicture));
    preview->shown = wr_alloc(1, sizeof(WrPreviewPicture));
    preview->work = wr_alloc(1, sizeof(WrPreviewPicture));
    return preview;
}

void wr_preview_free(WrPreview *preview)
{
    if (!preview) return;
    wr_mutex_lock(&preview->lock);
    preview->quit = true;
    __atomic_store_n(&preview->cancel, 1, __ATOMIC_RELAXED);
    wr_cond_wake(&preview->wake);
    wr_mutex_unlock(&preview->lock);
    if (preview->started) wr_thread_join(preview->thread);
    wr_choice_fini(&preview->choice);
    wr_renderer_free(preview->renderer);
    wr_pool_free(preview->pool);
    request_clear(&preview->next);
    request_clear(&preview->now);
    wr_picture_free(preview->done);
    wr_picture_free(preview->shown);
    wr_picture_free(preview->work);
    wr_free(preview->ran.map);
    wr_free(preview->isa);
    wr_cond_fini(&preview->wake);
    wr_mutex_fini(&preview->lock);
    wr_free(preview);
}

/* ---- the worker thread ---- */

static void fail(WrPreview *preview, const WrError *err)
{
    wr_mutex_lock(&preview->lock);
    preview->failed = true;
    preview->error = *err;
    wr_mutex_unlock(&preview->lock);
}

static void notify(WrPreview *preview)
{
    SDL_Event event = { .type = preview->ready_event };
    SDL_PushEvent(&event);
}

static WrDials dials_for(const Wish *wish, WrPreviewLevel level, WrMovingWay way)
{
    WrDials dials = wish->scene->dials;
    const WrAntialias aa = dials.aa;
    int own = aa == WR_AA_SUPERSAMPLE ? dials.samples : 1;
    bool rests = level == WR_PREVIEW_SMOOTH || level == WR_PREVIEW_FINAL;
    /* Filtered and adaptive pictures use the scene's own method once the view is static. */
    if (rests && aa != WR_AA_POINT && aa != WR_AA_SUPERSAMPLE) return dials;
    dials.aa = WR_AA_POINT;
    dials.samples = 1;
    if (level == WR_PREVIEW_MOVING) {
        wr_moving_dials(way, &dials);
        /* Shadows among objects have hard edges, and those of an object on itself wait for rest. */
        const int rays = wr_scene_object_count(wish->scene) > 1 ? 1 : 0;
        if (dials.rays > rays) dials.rays = rays;
        dials.arithmetic = WR_ARITHMETIC_FAST;
        dials.shading = WR_SHADING_FLOAT;
    }
    if (rests) {
        dials.aa = WR_AA_SUPERSAMPLE;
        dials.samples = level == WR_PREVIEW_SMOOTH ? 2 : own > 4 ? own : 4;
    }
    return dials;
}

/* One-time preparations, such as slopes of a new table, do not predict the next picture's time. */
static void learn(WrPreview *preview, const WrPreviewPicture *picture)
{
    const Wish *wish = &preview->now;
    const double seconds = picture->seconds, prepare = picture->times.prepare;
    wr_moving_learn(&preview->moving, seconds - fmin(prepare, 0.8 * seconds),
                    (double)picture->width * picture->height, (double)wish->width * wish->height,
                    wish->painting ? QUICK_SECONDS : MOVING_SECONDS);
}

static bool has_tolerance(const Wish *wish)
{
    return wish->scene->tolerance.kind != WR_TOLERANCE_NONE;
}

/* Render with dials that meet the scene's tolerance: those already chosen for this view, those stored
   in the document, or, if neither fits this picture, newly chosen ones. */
static bool by_tolerance(WrPreview *preview, const WrFrameRequest *wanted, WrPreviewPicture *out,
                         WrFrame *frame, WrError *err)
{
    WrText text = { 0 };
    WrChoice *choice = &preview->choice;
    WrFrameRequest request = *wanted;
    request.dials = NULL;
    request.codes.wanted = false; /* the error is measured on floats */
    request.keep = false;
    wr_chosen_recall(preview->now.chosen, &request, choice);
    request.map = NULL;
    if (!wr_tolerance_frame(preview->renderer, &request, choice, frame, err)) return false;
    request.map = wanted->map;
    if (request.map && !wr_choice_frame(preview->renderer, &request, choice, frame, err))
        return false;
    wr_choice_summary(choice, &out->chosen);
    wr_chosen_write(choice, &request, &text);
    out->kept = wr_strdup(wr_text_get(&text));
    wr_text_fini(&text);
    return true;
}

static bool render(WrPreview *preview, WrRenderer *renderer, WrPool *pool, WrPreviewLevel level,
                   WrError *err)
{
    const Wish *wish = &preview->now;
    double started = wr_clock_seconds();
    const WrMovingWay way = preview->moving.way;
    double scale = level == WR_PREVIEW_MOVING ? preview->moving.scale : 1.0;
    WrDials dials = dials_for(wish, level, way);
    WrFrameRequest request = { .field = wish->field,
                               .fields = wr_tables_fields(wish->tables),
                               .scene = wish->scene,
                               .width = (int)fmax(1.0, rint(wish->width * scale)),
                               .height = (int)fmax(1.0, rint(wish->height * scale)),
                               .turn_deg = wish->turn_deg,
                               .dials = &dials,
                               .keep = level > WR_PREVIEW_MOVING,
                               .moving = level == WR_PREVIEW_MOVING,
                               .cancel = &preview->cancel };
    request.codes =
        wr_frame_codes_of(wish->scene, wish->scene->background.kind != WR_BACKGROUND_NONE);
    WrForce force[WR_EFFECT_COUNT] = { 0 };
    force[wish->look.effect] = wish->look.force;
    if (wish->look.force) request.force = force;
    WrFrame frame;
    WrPreviewPicture *out = preview->work;
    out->chosen.any = false;
    wr_free(out->kept);
    out->kept = NULL;
    out->ran = wish->look.ran;
    if (wish->look.ran && !wr_picture_heatmap_update(&preview->ran, &request, err)) return false;
    bool good = level == WR_PREVIEW_FINAL && has_tolerance(wish)
                    ? by_tolerance(preview, &request, out, &frame, err)
                    : wr_renderer_frame(renderer, &request, &frame, err);
    if (!good) return false;
    if (!wr_picture_room(out, frame.width, frame.height, err)) return false;
    wr_picture_put(out, &frame, &request, &wish->look, scale, &preview->ran, pool);
    out->level = level;
    out->way = way;
    out->scale = scale;
    out->turn_deg = wish->turn_deg;
    out->tag = wish->tag;
    out->times = frame.times;
    out->plan = *frame.plan;
    out->seconds = wr_clock_seconds() - started;
    out->serial = ++preview->serial;
    wr_picture_compare(out, preview->newest);
    if (preview->edited) preview->edit_seconds = out->seconds;
    if (level == WR_PREVIEW_MOVING) learn(preview, out);
    return true;
}

/* Look up the requested point in the last picture. */
static void answer_point(WrPreview *preview, WrRenderer *renderer, int width, int height)
{
    wr_mutex_lock(&preview->lock);
    double x = preview->point_x, y = preview->point_y, u = 0.0, v = 0.0;
    preview->point_new = false;
    wr_mutex_unlock(&preview->lock);
    int face;
    bool hit = x >= 0.0 && x <= 1.0 && y >= 0.0 && y <= 1.0 &&
               wr_renderer_pick(renderer, x * width, y * height, &u, &v, &face);
    wr_mutex_lock(&preview->lock);
    preview->point_hit = hit;
    preview->point_u = u;
    preview->point_v = v;
    wr_mutex_unlock(&preview->lock);
}

/* True if the request differs from the displayed picture only by an edit of the table, so that only the dirty region
   needs an update. */
static bool only_edited(const WrPreview *preview)
{
    const Wish *now = &preview->now, *next = &preview->next;
    return now->field && preview->level > WR_PREVIEW_MOVING && !next->moving && !now->moving &&
           wr_preview_look_same(&now->look, &next->look) && now->scene == next->scene &&
           now->turn_deg == next->turn_deg && now->width == next->width &&
           now->height == next->height;
}

/* True if so much of the table changed that all of the picture is drawn again, as by undo of a filter or with a layer hidden:
   roughly at first, like any other change of the whole. */
static bool is_large(const WrField *was, const WrField *now)
{
    return !wr_field_alike(was, now) ||
           wr_field_changed_tiles(was, now) > wr_field_tiles_u(now) * wr_field_tiles_v(now) / 8;
}

/* Start the next request, or refine the present one; false: nothing to do. Called with the lock held. */
static bool choose(WrPreview *preview, WrPreviewLevel *level)
{
    if (preview->next.field) {
        bool edited = only_edited(preview);
        const bool large = edited && is_large(preview->now.field, preview->next.field);
        request_clear(&preview->now);
        preview->now = preview->next;
        preview->next = (Wish){ 0 };
        __atomic_store_n(&preview->cancel, 0, __ATOMIC_RELAXED);
        preview->edited = edited && preview->level > WR_PREVIEW_FULL;
        if (edited) {
            const bool rough =
                large || (preview->now.painting &&
                          (preview->edit_seconds > EDIT_SECONDS || has_tolerance(&preview->now)));
            *level = rough ? WR_PREVIEW_FULL : preview->level;
            preview->edited = preview->edited && !rough;
            return true;
        }
        preview->level = WR_PREVIEW_NONE;
        preview->edit_seconds = 0.0;
        *level = preview->now.moving || preview->serial == 0 ? WR_PREVIEW_MOVING : WR_PREVIEW_FULL;
        return true;
    }
    bool rests = preview->now.field && !preview->now.moving && !preview->now.painting;
    WrPreviewLevel finest = preview->started ? WR_PREVIEW_FINAL : WR_PREVIEW_FULL;
    if (rests && preview->level < finest && preview->level != WR_PREVIEW_NONE) {
        preview->edited = false;
        *level = preview->level + 1;
        return true;
    }
    return false;
}

/* Deliver the finished picture. Called with the lock held. */
static void publish(WrPreview *preview)
{
    WrPreviewPicture *finished = preview->work;
    if (preview->fresh) wr_picture_follow(finished, preview->done);
    preview->work = preview->done;
    preview->newest = preview->done = finished;
    preview->fresh = true;
}

static void work(WrPreview *preview, WrPreviewLevel level)
{
    WrError err = { "" };
    bool ok = render(preview, preview->renderer, preview->pool, level, &err);
    bool cancelled = __atomic_load_n(&preview->cancel, __ATOMIC_RELAXED) != 0;
    if (!ok && !cancelled) fail(preview, &err);
    if (ok) {
        preview->last_width = preview->work->width;
        preview->last_height = preview->work->height;
        answer_point(preview, preview->renderer, preview->last_width, preview->last_height);
    }
    wr_mutex_lock(&preview->lock);
    preview->level = ok ? level : WR_PREVIEW_NONE;
    if (ok) publish(preview);
    wr_mutex_unlock(&preview->lock);
    if (ok || !cancelled) notify(preview);
}

static void begin(WrPreview *preview)
{
    WrError err = { "" };
    if (preview->pool) return;
    preview->pool = wr_pool_new(preview->threads);
    preview->renderer = wr_renderer_new(preview->pool, preview->isa, &err);
    if (!preview->renderer) fail(preview, &err);
}

/* Make one picture, or one answer; false: nothing left to do. Called with the lock held, which is released
   meanwhile. */
static bool step(WrPreview *preview)
{
    WrPreviewLevel level;
    if (preview->renderer && choose(preview, &level)) {
        preview->settled = false;
        wr_mutex_unlock(&preview->lock);
        work(preview, level);
        wr_mutex_lock(&preview->lock);
        return true;
    }
    bool news = !preview->settled;
    preview->settled = true;
    if (preview->renderer && preview->point_new && preview->last_width > 0) {
        wr_mutex_unlock(&preview->lock);
        answer_point(preview, preview->renderer, preview->last_width, preview->last_height);
        notify(preview);
        wr_mutex_lock(&preview->lock);
        return true;
    }
    if (news) notify(preview);
    return false;
}

static void *thread_main(void *arg)
{
    WrPreview *preview = arg;
    wr_thread_step_back(); /* lower priority than the window's thread */
    begin(preview);
    wr_mutex_lock(&preview->lock);
    while (!preview->quit)
        if (!step(preview)) wr_cond_wait(&preview->wake, &preview->lock);
    wr_mutex_unlock(&preview->lock);
    return NULL;
}

/* Without a thread: render on the caller's thread, which waits, with at most one sample per pixel. */
static void work_in_place(WrPreview *preview)
{
    begin(preview);
    wr_mutex_lock(&preview->lock);
    while (step(preview)) {
    }
    wr_mutex_unlock(&preview->lock);
}

/* ---- on the window's thread ---- */

void wr_preview_want(WrPreview *preview, const WrPreviewRequest *wish)
{
    wr_mutex_lock(&preview->lock);
    request_clear(&preview->next);
    preview->next = (Wish){ .field = wr_field_share(wish->field),
                            .tables = wr_tables_share(wish->tables),
                            .scene = wr_scene_share(wish->scene),
                            .turn_deg = wish->turn_deg,
                            .width = wish->width,
                            .height = wish->height,
                            .tag = wish->tag,
                            .chosen = wish->chosen ? wr_strdup(wish->chosen) : NULL,
                            .moving = wish->moving,
                            .painting = wish->painting,
                            .look = wish->look };
    /* A moving picture ends soon; a high-quality one would delay the new request. */
    if (!preview->now.moving) __atomic_store_n(&preview->cancel, 1, __ATOMIC_RELAXED);
    preview->settled = false;
    if (!preview->started)
        preview->started = wr_thread_start(&preview->thread, thread_main, preview);
    bool alone = !preview->started;
    wr_cond_wake(&preview->wake);
    wr_mutex_unlock(&preview->lock);
    if (alone) work_in_place(preview);
}

void wr_preview_point(WrPreview *preview, double x, double y)
{
    wr_mutex_lock(&preview->lock);
    if (x != preview->point_x || y != preview->point_y) {
        preview->point_x = x;
        preview->point_y = y;
        preview->point_new = true;
        wr_cond_wake(&preview->wake);
    }
    bool alone = !preview->started && preview->pool && preview->point_new;
    wr_mutex_unlock(&preview->lock);
    if (alone) work_in_place(preview);
}

bool wr_preview_point_hit(WrPreview *preview, double *u, double *v)
{
    wr_mutex_lock(&preview->lock);
    bool hit = preview->point_hit;
    *u = preview->point_u;
    *v = preview->point_v;
    wr_mutex_unlock(&preview->lock);
    return hit;
}

const WrPreviewPicture *wr_preview_picture(WrPreview *preview)
{
    wr_mutex_lock(&preview->lock);
    if (preview->fresh) {
        WrPreviewPicture *newest = preview->done;
        preview->done = preview->shown;
        preview->shown = newest;
        preview->fresh = false;
    }
    wr_mutex_unlock(&preview->lock);
    return preview->shown;
}

bool wr_preview_settled(WrPreview *preview)
{
    wr_mutex_lock(&preview->lock);
    bool settled = preview->settled;
    wr_mutex_unlock(&preview->lock);
    return settled;
}

bool wr_preview_error(WrPreview *preview, WrError *err)
{
    wr_mutex_lock(&preview->lock);
    bool failed = preview->failed;
    if (failed) *err = preview->error;
    preview->failed = false;
    wr_mutex_unlock(&preview->lock);
    return failed;
}

/* ---- dials that a tolerance chose ---- */

void wr_choice_summary(const WrChoice *choice, WrChosen *out)
{
    const WrScene *s = choice->dials;
    *out = (WrChosen){ .any = s != NULL, .met = choice->met, .kept = choice->studies == 0 };
    if (!s) return;
    const int grid = s->dials.aa == WR_AA_POINT ? 1 : s->dials.samples;
    for (int d = 0; d < WR_DIAL_COUNT; d++) out->dials[d] = wr_dials[d].get(s);
    snprintf(out->reason, sizeof out->reason, "%s", choice->reason);
    snprintf(out->line, sizeof out->line, "%s %s %d\xc3\x97%d", wr_bumps[s->bump].name,
             wr_schemes[s->scheme].name, grid, grid);
}
