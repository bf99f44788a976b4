/* Pictures and films of a session's document. */
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "command/session_internal.h"
#include "document/document.h"
#include "document/object_tables.h"
#include "export/export.h"
#include "export/film.h"
#include "render/frame/frame.h"
#include "scene/scene.h"
#include "system/clock.h"
#include "system/path.h"

#include <math.h>
#include <string.h>

/* ---- stored dials that a tolerance chose ---- */

void wr_session_keep_chosen(WrSession *session, const char *text)
{
    wr_free(session->state.chosen);
    session->state.chosen = text ? wr_strdup(text) : NULL;
    session->state.misfit_reported = false;
}

const char *wr_session_chosen(const WrSession *session)
{
    return session->state.chosen;
}

static WrChoiceOrigin origin_of(const WrFrameRequest *request)
{
    WrText text = { 0 };
    wr_print_identity(request->scene, &text);
    const char *lines = wr_text_get(&text);
    const WrChoiceOrigin origin = { .table = wr_choice_tables_hash(request),
                                    .scene =
                                        wr_hash_bytes(lines, strlen(lines), (WrHash){ 0, 0 }) };
    wr_text_fini(&text);
    return origin;
}

const char *wr_chosen_recall(const char *kept, const WrFrameRequest *request, WrChoice *choice)
{
    if (!kept || wr_choice_fits(choice, request)) return NULL;
    const WrChoiceOrigin origin = origin_of(request);
    const char *misfit = wr_choice_misfit(kept, &origin, request);
    if (!misfit) wr_choice_read(kept, request, choice);
    return misfit;
}

void wr_chosen_write(const WrChoice *choice, const WrFrameRequest *request, WrText *text)
{
    const WrChoiceOrigin origin = origin_of(request);
    wr_choice_write(choice, &origin, text);
}

/* If no dials are chosen for that picture yet, use the stored dials of the document if they fit. If they do not, a
   note reports it once. */
static void session_recall_chosen(WrSession *session, const WrFrameRequest *request)
{
    WrSessionState *state = &session->state;
    const char *misfit = wr_chosen_recall(state->chosen, request, &session->choice);
    if (misfit && !state->misfit_reported) {
        wr_session_note(
            session,
            "the dials stored in the document were chosen for another %s, and are chosen again",
            misfit);
        state->misfit_reported = true;
    }
}

/* Dials of the last picture, if they still fit the document; else the stored ones. */
static void add_of(WrSession *session, const WrFrameRequest *request, WrText *text)
{
    const WrChoice *choice = &session->choice;
    const bool fresh = choice->dials && choice->scene == request->scene &&
                       choice->tables_key == wr_choice_tables_key(request);
    if (!fresh && !session->state.chosen) return;
    const WrChoiceOrigin origin = origin_of(request);
    WrText chosen = { 0 };
    if (fresh) wr_choice_write(choice, &origin, &chosen);
    else if (wr_choice_is_for(session->state.chosen, &origin))
        wr_text_add(&chosen, session->state.chosen);
    if (chosen.length > 0) {
        wr_text_add(text, " chosen=");
        wr_text_add_word(text, wr_text_get(&chosen));
    }
    wr_text_fini(&chosen);
}

static void add_chosen(WrSession *session, WrText *text)
{
    const WrDocument *document = session->state.document;
    WrPool *pool = session->options.pool;
    if (document->scene->tolerance.kind == WR_TOLERANCE_NONE) return;
    WrTables *tables = wr_document_tables(document, document->scene, &session->table_cache, pool);
    const WrFrameRequest request = { .field = wr_document_composite(document, pool),
                                     .fields = wr_tables_fields(tables),
                                     .scene = document->scene };
    add_of(session, &request, text);
    wr_tables_free(tables);
}

/* Append the dials to the line of a tolerance. */
static void go_on(void *ctx, const WrCommand *command, WrText *text)
{
    if (!command->print_end) return;
    text->data[--text->length] = '\0';
    add_chosen(ctx, text);
    wr_text_add(text, "\n");
}

void wr_session_kept_text(WrSession *session, WrText *text)
{
    wr_print_scene(session->state.document->scene, go_on, (void *)session, text);
}

/* ---- pictures in memory and in files ---- */

/* Pictures of the document, in memory or written to files in bands of rows, so that a large one needs only one band
   of memory. */

#define DRAWN 0.8 /* share of a picture's work for drawing; the rest is the file */

/* The composite, which is not made where each object uses a layer of its own. A tolerance's choice depends on it. */
static const WrField *field_for(const WrSession *session)
{
    const WrDocument *document = session->state.document;
    const WrTables *tables = session->tables;
    int own = 0;
    while (tables && own < tables->count && tables->fields[own]) own++;
    if (own > 0 && own == tables->count && document->scene->tolerance.kind == WR_TOLERANCE_NONE)
        return tables->fields[0];
    return wr_document_composite(document, session->options.pool);
}

static bool make_request(WrSession *session, int width, int height, double turn_deg,
                         WrFrameRequest *out, WrError *err)
{
    if (!session->renderer)
        session->renderer = wr_renderer_new(session->options.pool, session->options.isa, err);
    if (!session->renderer) return false;
    const WrProgress *here = wr_progress_here();
    const WrDocument *document = session->state.document;
    wr_filters_forget();
    wr_tables_free(session->tables);
    session->tables =
        wr_document_tables(document, document->scene, &session->table_cache, session->options.pool);
    *out = (WrFrameRequest){ .field = field_for(session),
                             .fields = wr_tables_fields(session->tables),
                             .scene = document->scene,
                             .width = width,
                             .height = height,
                             .turn_deg = turn_deg,
                             .full = session->options.full,
                             .cancel = here ? here->cancel : NULL };
    return wr_filters_carried(err);
}

bool wr_session_frame(WrSession *session, int width, int height, double turn_deg, WrFrame *frame,
                      WrError *err)
{
    WrFrameRequest request;
    if (!make_request(session, width, height, turn_deg, &request, err)) return false;
    if (request.scene->tolerance.kind == WR_TOLERANCE_NONE)
        return wr_renderer_frame(session->renderer, &request, frame, err);
    session_recall_chosen(session, &request);
    return wr_tolerance_frame(session->renderer, &request, &session->choice, frame, err);
}

/* Dials of a picture that is drawn again: those already chosen under a tolerance, else NULL (its own). */
static bool choice_for(WrSession *session, const WrFrameRequest *request, const WrChoice **out,
                       WrError *err)
{
    WrFrame frame;
    *out = NULL;
    if (request->scene->tolerance.kind == WR_TOLERANCE_NONE) return true;
    *out = &session->choice;
    return wr_choice_fits(*out, request) ||
           wr_session_frame(session, request->width, request->height, request->turn_deg, &frame,
                            err);
}

bool wr_session_savings(WrSession *session, int width, int height, double turn_deg,
                        WrSaving savings[WR_EFFECT_COUNT], WrError *err)
{
    WrFrameRequest request;
    const WrChoice *choice;
    const WrSavingRequest ask = { .pool = session->options.pool,
                                  .isa = session->options.isa,
                                  .frame = &request };
    if (!make_request(session, width, height, turn_deg, &request, err) ||
        !choice_for(session, &request, &choice, err))
        return false;
    if (choice) request.scene = choice->dials;
    return wr_savings_measure(&ask, savings, err);
}

bool wr_session_map(WrSession *session, int width, int height, double turn_deg, uint8_t *map,
                    WrError *err)
{
    WrFrameRequest request;
    WrFrame frame;
    const WrChoice *choice;
    if (!make_request(session, width, height, turn_deg, &request, err) ||
        !choice_for(session, &request, &choice, err))
        return false;
    request.map = map;
    memset(map, 0, (size_t)width * (size_t)height);
    return choice ? wr_choice_frame(session->renderer, &request, choice, &frame, err)
                  : wr_renderer_frame(session->renderer, &request, &frame, err);
}

/* With a tolerance: choose dials once for all pictures of a turn; later pictures of that size use them. A note
   reports the choice. */
static bool session_turn(WrSession *session, int width, int height, const double *turn_deg,
                         int count, WrError *err)
{
    WrFrameRequest request;
    if (!make_request(session, width, height, turn_deg[0], &request, err)) return false;
    if (request.scene->tolerance.kind == WR_TOLERANCE_NONE || count < 2) return true;
    if (!wr_tolerance_turn(session->renderer, &request, turn_deg, count, &session->choice, err))
        return false;
    wr_session_note(session, "%s", session->choice.reason);
    session->choice.shown = true;
    return true;
}

const WrChoice *wr_session_choice(const WrSession *session)
{
    return &session->choice;
}

/* ---- files ---- */

/* A picture being written to a file, from the top. */
typedef struct Picture {
    WrSession *session;
    WrFrameRequest request;
    WrFrame frame;      /* rows of the present band */
    int top, bottom;    /* the file's rows of the picture, [top, bottom) */
    int first;          /* first row of the band */
    int step;           /* rows of a band */
    double drawn;       /* share of a band's work for drawing; the rest is the file */
    bool linear, alpha; /* file formats: linear float; 8-bit with alpha */
    int64_t replaced;
    int64_t clipped; /* over-exposed pixels: a channel at 255 */
} Picture;

/* Rows of a band: whole strips, as in files; the whole picture if it fits. pixel: bytes. */
static int band_rows(const WrSession *session, int width, int height, size_t pixel)
{
    const size_t most =
        session->options.picture_bytes ? session->options.picture_bytes : WR_PICTURE_BYTES;
    const size_t row = (size_t)(width > 0 ? width : 1) * pixel;
    const size_t strips = most / row / WR_IMAGE_STRIP;
    if (strips * WR_IMAGE_STRIP >= (size_t)height) return height;
    return strips > 0 ? (int)strips * WR_IMAGE_STRIP : WR_IMAGE_STRIP;
}

/* Progress of the picture for a share of the present band. */
static double done_of(const Picture *picture, double share)
{
    return (picture->first - picture->top + share * picture->frame.height) /
           (picture->bottom - picture->top);
}

static bool draw(Picture *picture, WrError *err)
{
    if (!wr_renderer_frame(picture->session->renderer, &picture->request, &picture->frame, err))
        return false;
    picture->replaced += picture->frame.not_finite;
    return true;
}

static bool draw_band(Picture *picture, int y, WrError *err)
{
    WrProgressPart part;
    const int left = picture->bottom - y;
    picture->first = y;
    picture->frame.height = left < picture->step ? left : picture->step;
    picture->request.first = y;
    picture->request.rows = picture->frame.height;
    const WrProgress *whole =
        wr_progress_enter(&part, done_of(picture, 0.0), done_of(picture, picture->drawn));
    const bool good = draw(picture, err);
    wr_progress_set(whole);
    return good;
}

/* Count over-exposed pixels. Only for scenes with tone mapping or environment light: in others a highlight is meant
   to be white. */
static void count_clipped(Picture *picture, int rows, const uint8_t *codes)
{
    const WrScene *scene = picture->request.scene;
    const size_t channels = picture->alpha ? 4 : 3;
    const size_t count = (size_t)picture->request.width * (size_t)rows;
    if (picture->linear) return;
    const WrToneCurve tone = wr_tone_curve_params(&scene->tone);
    if ((!scene->environment.light && tone.plain) || tone.view) return;
    for (size_t i = 0; i < count; i++, codes += channels)
        picture->clipped += codes[0] == 255 || codes[1] == 255 || codes[2] == 255;
}

#define CLIPPED_TOLD 0.005 /* share of over-exposed pixels that is reported: less is sparkle */

static void report_clipped(const Picture *picture, const char *path)
{
    const double pixels = (double)picture->request.width * (picture->bottom - picture->top);
    const double share = (double)picture->clipped / pixels;
    if (share > CLIPPED_TOLD)
        wr_session_note(picture->session,
                        "%s: %.1f %% of the pixels are clipped; `tone soft`, or less exposure, "
                        "shows what is there",
                        path, 100 * share);
}

/* Rows of the file: linear float, or 8-bit sRGB over the scene's background. */
static bool give_rows(void *ctx, int y, int rows, void *out, WrError *err)
{
    Picture *picture = ctx;
    y += picture->top;
    if (y >= picture->first + picture->frame.height && !draw_band(picture, y, err)) return false;
    const size_t width = (size_t)picture->request.width, row = width * 4 * sizeof(float);
    const size_t before = (size_t)(y - picture->first) * width;
    WrFrame strip = picture->frame;
    if (strip.rgba) strip.rgba += 4 * before;
    strip.height = rows;
    strip.first = y;
    if (strip.codes) wr_codes_to_rgb(strip.codes + before, (size_t)rows * width, out);
    else if (picture->linear) memcpy(out, strip.rgba, (size_t)rows * row);
    else if (picture->alpha)
        picture->replaced += wr_frame_to_alpha8(&strip, &picture->request.scene->tone, out,
                                                picture->session->options.pool);
    else
        picture->replaced += wr_frame_to_srgb8(&strip, &picture->request.codes, false, out,
                                               picture->session->options.pool);
    count_clipped(picture, rows, out);
    const double share = (double)(y + rows - picture->first) / picture->frame.height;
    return wr_progress_report(done_of(picture, picture->drawn + (1 - picture->drawn) * share)) ||
           wr_fail(err, "cancelled");
}

/* Draw before the file is begun: the whole picture if it is kept in memory anyway. A tolerance applies to the picture
   as a whole. */
static bool draw_first(Picture *picture, WrError *err)
{
    const WrFrameRequest *request = &picture->request;
    const bool whole = request->scene->tolerance.kind != WR_TOLERANCE_NONE;
    if (picture->step < request->height && !whole) {
        picture->drawn = DRAWN;
        return true;
    }
    if (whole ? !wr_session_frame(picture->session, request->width, request->height,
                                  request->turn_deg, &picture->frame, err)
              : !draw(picture, err)) {
        if (whole && picture->step < request->height && !wr_progress_stopped())
            wr_error_prefix(err,
                            "under a tolerance a picture is held whole, without one (`tolerance "
                            "off`) a band of it: ");
        return false;
    }
    picture->step = request->height;
    return true;
}

static void report_choice(WrSession *session, const char *path)
{
    if (session->state.document->scene->tolerance.kind == WR_TOLERANCE_NONE ||
        !session->choice.dials || session->choice.met || session->choice.shown)
        return;
    wr_session_note(session, "%s: %s", path, session->choice.reason);
    session->choice.shown = true;
}

static bool write_picture(Picture *picture, const char *path, WrError *err)
{
    const WrImageOut out = { .width = picture->request.width,
                             .height = picture->bottom - picture->top,
                             .channels = picture->linear || picture->alpha ? 4 : 3,
                             .type = picture->linear ? WR_PIXEL_F32 : WR_PIXEL_U8,
                             .data = picture->linear,
                             .rows = give_rows,
                             .ctx = picture,
                             .reports = true };
    if (!wr_image_write(path, &out, 1, err)) return false;
    if (picture->replaced)
        wr_session_note(picture->session, "%s: %lld values were not finite and became 0", path,
                        (long long)picture->replaced);
    report_clipped(picture, path);
    return true;
}

/* Check before a long computation that the file can be written. */
static bool check_target(const char *path, WrError *err)
{
    WrFileTarget target = { 0 };
    if (!wr_file_begin(&target, path, err)) return false;
    wr_file_abort(&target);
    return true;
}

/* exr, tif and tiff hold linear float. */
static bool is_linear(const char *path)
{
    char buffer[16];
    const char *ending = wr_path_ending(path, buffer);
    return strcmp(ending, "exr") == 0 || strcmp(ending, "tif") == 0 || strcmp(ending, "tiff") == 0;
}

/* True if the file is 8-bit with alpha and no background. */
static bool has_alpha(const WrSession *session, const char *path)
{
    return session->state.document->scene->background.kind == WR_BACKGROUND_NONE &&
           !is_linear(path) && wr_image_can_write(path, WR_PIXEL_U8, 4, false, NULL);
}

bool wr_session_has_rendered(const WrSession *session, const char *path, int width, int height)
{
    static const WrImageRequest as_it_is = { .keep_lost = true };
    const bool linear = is_linear(path);
    if (!wr_path_is_there(path)) return false; /* avoids starting a reader process */
    WrImageRows *rows = wr_image_rows_open(path, &as_it_is, NULL);
    if (!rows) return false;
    const WrImage *head = wr_image_rows_head(rows);
    bool whole = head->width == width && head->height == height &&
                 head->channels == (linear || has_alpha(session, path) ? 4 : 3) &&
                 head->type == (linear ? WR_PIXEL_F32 : WR_PIXEL_U8);
    for (int y = 0; whole && y < height; y++) whole = wr_image_rows_get(rows, y, NULL) != NULL;
    wr_image_rows_close(rows);
    return whole;
}

/* Render to memory: 8-bit sRGB over the background, or with `alpha` over a transparent one, [height][width][3 or
   4]. */
static bool session_pixels(WrSession *session, int width, int height, double turn_deg, bool alpha,
                           uint8_t *out, WrError *err)
{
    Picture picture = { .session = session, .alpha = alpha, .step = height, .bottom = height };
    if (!make_request(session, width, height, turn_deg, &picture.request, err)) return false;
    const WrScene *scene = picture.request.scene;
    picture.request.codes =
        wr_frame_codes_of(scene, !alpha && scene->tolerance.kind == WR_TOLERANCE_NONE);
    WrProgressPart part;
    const WrProgress *whole = wr_progress_enter(&part, 0.0, DRAWN);
    bool good = draw_first(&picture, err);
    wr_progress_set(whole);
    if (!good) return false;
    wr_progress_enter(&part, DRAWN, 1.0);
    good = give_rows(&picture, 0, height, out, err);
    wr_progress_set(whole);
    return good;
}

bool wr_session_render(WrSession *session, const char *path, int width, int height,
                       const WrPictureRows *rows, double turn_deg, WrError *err)
{
    const bool linear = is_linear(path);
    Picture picture = { .session = session,
                        .linear = linear,
                        .alpha = has_alpha(session, path),
                        .top = rows ? rows->first : 0,
                        .bottom = rows ? rows->first + rows->count : height };
    if (picture.bottom > height)
        return wr_fail(err, "rows %d-%d: the picture has rows 0 to %d", picture.top,
                       picture.bottom - 1, height - 1);
    if (!wr_image_can_write(path, linear ? WR_PIXEL_F32 : WR_PIXEL_U8,
                            linear || picture.alpha ? 4 : 3, linear, err))
        return false;
    if (!check_target(path, err) ||
        !make_request(session, width, height, turn_deg, &picture.request, err))
        return false;
    const WrScene *scene = picture.request.scene;
    const bool floats = linear || picture.alpha;
    picture.step = band_rows(session, width, picture.bottom - picture.top,
                             floats ? 4 * sizeof(float) : sizeof(uint32_t));
    picture.request.codes =
        wr_frame_codes_of(scene, !floats && scene->tolerance.kind == WR_TOLERANCE_NONE);
    const double began = wr_clock_seconds();
    WrProgressPart part;
    const WrProgress *whole = wr_progress_enter(&part, 0.0, DRAWN);
    bool good = draw_first(&picture, err);
    wr_progress_set(whole);
    if (!good) return false;
    report_choice(session, path);
    wr_progress_enter(&part, picture.drawn > 0 ? 0.0 : DRAWN, 1.0);
    good = write_picture(&picture, path, err);
    wr_progress_set(whole);
    const WrExportReport report = { .width = width,
                                    .height = picture.bottom - picture.top,
                                    .channels = floats ? 4 : 3,
                                    .depth = linear ? 32 : 8 };
    if (good) wr_session_receipt(session, path, "picture", &report, began);
    return good;
}

/* ---- Turntables as picture files or as one film ---- */

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
                       "%s: for several frames the name must contain #### for the frame number, or "
                       "end in gif, apng, webp or mp4 for a film",
                       path);
    if (film && turntable->missing)
        return wr_fail(err, "%s: missing frames can be found for files with ####, not in a film",
                       path);
    if (!film && (turntable->fps > 0 || turntable->loop >= 0))
        return wr_fail(err, "%s: fps= and loop= are only for films: gif, apng, webp, mp4", path);
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
        session_turn(turning->session, order->width, order->height, angles, turning->total, err);
    wr_free(angles);
    return turning->chosen;
}

static bool add_frame(Turning *turning, int frame, WrError *err)
{
    const WrTurntable *order = turning->order;
    return (turning->chosen || choose_for_all(turning, err)) &&
           session_pixels(turning->session, order->width, order->height, angle_of(turning, frame),
                          turning->alpha, turning->pixels, err) &&
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
               wr_session_render(turning->session, path, order->width, order->height, NULL,
                                 angle_of(turning, frame), err) &&
               ++turning->written;
    wr_text_fini(&name);
    return good;
}

#define FILM_DRAWN 0.95 /* share of a film's work for drawing; the rest is the read-back */

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
    const double began = wr_clock_seconds();
    bool good = begin_film(turning, err) && all_frames(turning, FILM_DRAWN, err);
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
    const WrExportReport size = { .width = report.width,
                                  .height = report.height,
                                  .channels = turning->alpha ? 4 : 3,
                                  .depth = 8 };
    wr_session_receipt(turning->session, turning->path, "film", &size, began);
    return true;
}

static bool make_files(Turning *turning, WrError *err)
{
    const bool good = all_frames(turning, 1.0, err);
    if (turning->there > 0)
        wr_session_note(turning->session, "%d of %d frames already existed", turning->there,
                        turning->order->last - turning->order->first + 1);
    /* Finished frames are useful and may have taken long, so they stay. */
    if (!good && turning->written > 0)
        wr_session_note(turning->session,
                        "%s: %d of %d frames are new, the others are unchanged; `wrinkle render "
                        "--missing` renders the missing ones",
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
