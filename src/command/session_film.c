/* Turntables as picture files or as one film. */
#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "command/session_internal.h"
#include "document/document.h"
#include "export/film.h"

#include <math.h>
#include <string.h>

#define FPS 25.0 /* default frame rate of films */

WrTurntable wr_turntable_default(void)
{
    return (WrTurntable){ .width = 512, .height = 512, .first = 1, .last = 120, .loop = -1 };
}

static bool is_film(const char *path)
{
    return !strchr(path, '#') && wr_film_kind(path);
}

bool wr_turntable_check(const WrTurntable *turntable, const char *path, WrError *err)
{
    const bool film = is_film(path);
    if (!film && !strchr(path, '#'))
        return wr_fail(err,
                       "%s: the name of several frames must hold #### for the frame's number, or "
                       "end as a film's does: gif, apng, webp or mp4",
                       path);
    if (film && turntable->missing)
        return wr_fail(err, "%s: what is missing can be told of files with ####, not of a film",
                       path);
    if (!film && (turntable->fps > 0 || turntable->loop >= 0))
        return wr_fail(err, "%s: frames a second and loops are of films: gif, apng, webp, mp4",
                       path);
    return true;
}

/* `out` with its last run of # replaced by the number, zero-padded to the length of the run. */
static void frame_name(const char *out, int number, WrText *name)
{
    const char *end = strrchr(out, '#') + 1, *start = end;
    while (start > out && start[-1] == '#') start--;
    wr_text_clear(name);
    wr_text_add_n(name, out, (size_t)(start - out));
    wr_text_addf(name, "%0*d%s", (int)(end - start), number, end);
}

/* A turntable in progress. */
typedef struct Turning {
    WrSession *session;
    const WrTurntable *order;
    const char *path;
    int total;       /* frames of the whole turn */
    double step_deg; /* per frame */
    bool chosen;     /* dials were chosen for all frames */
    int there;       /* skipped existing frames */
    int written;     /* written files */
    WrFilm *film;    /* NULL: separate files */
    uint8_t *pixels; /* one film frame; owned */
    bool alpha;
} Turning;

/* Each frame's angle is computed from its number alone: fmod is exact, so no error accumulates (HC87). */
static double angle_of(const Turning *turning, int frame)
{
    return fmod(turning->order->turn_deg, 360) + fmod(frame * turning->step_deg, 360);
}

/* Under a tolerance, dials are chosen once for the whole turn, not only for the requested frames. */
static bool choose_for_all(Turning *turning, WrError *err)
{
    const WrTurntable *order = turning->order;
    const int first = order->stepped && !order->of ? order->first : 1;
    double *angles = wr_alloc((size_t)turning->total, sizeof *angles);
    for (int i = 0; i < turning->total; i++) angles[i] = angle_of(turning, first + i);
    turning->chosen =
        wr_session_turn(turning->session, order->width, order->height, angles, turning->total, err);
    wr_free(angles);
    return turning->chosen;
}

static bool add_frame(Turning *turning, int frame, WrError *err)
{
    const WrTurntable *order = turning->order;
    return (turning->chosen || choose_for_all(turning, err)) &&
           wr_session_pixels(turning->session, order->width, order->height,
                             angle_of(turning, frame), turning->alpha, turning->pixels, err) &&
           wr_film_add(turning->film, turning->pixels, err);
}

static bool write_frame(Turning *turning, int frame, WrError *err)
{
    const WrTurntable *order = turning->order;
    WrText name = { 0 };
    bool good = true;
    frame_name(turning->path, frame, &name);
    const char *path = wr_text_get(&name);
    if (order->missing &&
        wr_session_has_rendered(turning->session, path, order->width, order->height))
        turning->there++;
    else
        good = (turning->chosen || choose_for_all(turning, err)) &&
               wr_session_render(turning->session, path, order->width, order->height,
                                 angle_of(turning, frame), err) &&
               ++turning->written;
    wr_text_fini(&name);
    return good;
}

#define DRAWN 0.95 /* share of a film's work for drawing; the rest is the read-back */

static bool all_frames(Turning *turning, double share, WrError *err)
{
    const int first = turning->order->first, count = turning->order->last - first + 1;
    bool good = true;
    for (int i = 0; good && i < count; i++) {
        WrProgressPart part;
        const WrProgress *whole =
            wr_progress_enter(&part, share * i / count, share * (i + 1) / count);
        good = (turning->film ? add_frame : write_frame)(turning, first + i, err);
        wr_progress_set(whole);
        if (good && wr_progress_stopped()) good = wr_fail(err, "cancelled");
    }
    return good;
}

static bool begin_film(Turning *turning, WrError *err)
{
    const WrTurntable *order = turning->order;
    const bool bare =
        turning->session->state.document->scene->background.kind == WR_BACKGROUND_NONE;
    turning->alpha = bare && wr_film_kind(turning->path)->alpha;
    const WrFilmOptions options = { .width = order->width,
                                    .height = order->height,
                                    .fps = order->fps > 0 ? order->fps : FPS,
                                    .loop = order->loop > 0 ? order->loop : 0,
                                    .alpha = turning->alpha };
    if (order->last - order->first >= WR_FILM_FRAMES)
        return wr_fail(err, "%s: %d frames: a film has at most %d", turning->path,
                       order->last - order->first + 1, WR_FILM_FRAMES);
    turning->film = wr_film_begin(turning->path, &options, err);
    if (!turning->film) return false;
    turning->pixels = wr_try_alloc((size_t)order->width * (size_t)order->height,
                                   turning->alpha ? 4 : 3, "a frame", err);
    return turning->pixels != NULL;
}

static bool make_film(Turning *turning, WrError *err)
{
    WrFilmReport report;
    bool good = begin_film(turning, err) && all_frames(turning, DRAWN, err);
    if (good) {
        good = wr_film_end(turning->film, &report, err);
        turning->film = NULL;
    }
    wr_film_drop(turning->film);
    wr_free(turning->pixels);
    if (!good) return false;
    WrText text = { 0 };
    wr_film_report_text(&report, &text);
    wr_session_note(turning->session, "%s: %s", turning->path, wr_text_get(&text));
    wr_text_fini(&text);
    return true;
}

static bool make_files(Turning *turning, WrError *err)
{
    const bool good = all_frames(turning, 1.0, err);
    if (turning->there > 0)
        wr_session_note(turning->session, "%d of %d frames were there", turning->there,
                        turning->order->last - turning->order->first + 1);
    /* Finished frames are useful and may have taken long, so they stay. */
    if (!good && turning->written > 0)
        wr_session_note(turning->session,
                        "%s: %d of %d frames are new, the others as they were; `wrinkle render "
                        "--missing` draws "
                        "what is missing",
                        turning->path, turning->written,
                        turning->order->last - turning->order->first + 1);
    return good;
}

bool wr_session_turntable(WrSession *session, const char *path, const WrTurntable *turntable,
                          WrError *err)
{
    if (!wr_turntable_check(turntable, path, err)) return false;
    Turning turning = { .session = session,
                        .order = turntable,
                        .path = path,
                        .total = turntable->of ? turntable->of
                                               : turntable->last - turntable->first + 1 };
    turning.step_deg = turntable->stepped ? turntable->step_deg : 360.0 / turning.total;
    return (is_film(path) ? make_film : make_files)(&turning, err);
}
