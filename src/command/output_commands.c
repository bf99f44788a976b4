/* Commands that write files: save, export, render. */
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "command/args.h"
#include "command/commands.h"
#include "document/document.h"
#include "document/document_file.h"
#include "document/ora.h"
#include "export/export.h"
#include "render/frame.h"
#include "scene/scene.h"

#include <string.h>
#include <sys/stat.h>

/* ---- pictures ---- */

static bool make_request(WrSession *session, int width, int height, double turn_deg,
                         WrFrameRequest *out, WrError *err)
{
    if (!session->renderer)
        session->renderer = wr_renderer_new(session->options.pool, session->options.isa, err);
    if (!session->renderer) return false;
    const WrProgress *here = wr_progress_here();
    *out = (WrFrameRequest){ .field = wr_document_composite(session->state.document,
                                                            session->options.pool),
                             .scene = session->state.document->scene,
                             .width = width,
                             .height = height,
                             .turn_deg = turn_deg,
                             .full = session->options.full,
                             .cancel = here ? here->cancel : NULL };
    return true;
}

bool wr_session_frame(WrSession *session, int width, int height, double turn_deg, WrFrame *frame,
                      WrError *err)
{
    WrFrameRequest request;
    if (!make_request(session, width, height, turn_deg, &request, err)) return false;
    if (request.scene->tolerance.kind == WR_TOLERANCE_NONE)
        return wr_renderer_frame(session->renderer, &request, frame, err);
    wr_session_recall_chosen(session, &request);
    return wr_tolerance_frame(session->renderer, &request, &session->choice, frame, err);
}

bool wr_session_turn(WrSession *session, int width, int height, const double *turn_deg, int count,
                     WrError *err)
{
    WrFrameRequest request;
    if (!make_request(session, width, height, turn_deg[0], &request, err)) return false;
    if (request.scene->tolerance.kind == WR_TOLERANCE_NONE || count < 2) return true;
    if (!wr_tolerance_turn(session->renderer, &request, turn_deg, count, &session->choice, err))
        return false;
    wr_session_note(session, "%s", session->choice.reason);
    session->choice.told = true;
    return true;
}

const WrChoice *wr_session_choice(const WrSession *session)
{
    return &session->choice;
}

/* 8-bit sRGB over the scene's background. */
static bool write_codes(WrSession *session, const char *path, const WrFrame *frame, WrError *err)
{
    size_t pixels = (size_t)frame->width * (size_t)frame->height;
    uint8_t *codes = wr_try_alloc(pixels, 3, "the picture", err);
    if (!codes) return false;
    int64_t replaced = wr_frame_to_srgb8(frame, session->state.document->scene->background, false,
                                         codes, session->options.pool);
    if (replaced)
        wr_session_note(session, "%s: %lld values were not finite and became 0", path,
                        (long long)replaced);
    bool good =
        wr_image_write_pixels(path, frame->width, frame->height, 3, WR_PIXEL_U8, false, codes, err);
    wr_free(codes);
    return good;
}

/* The picture itself is most of the work, its file the rest. */
static bool frame_first(WrSession *session, int width, int height, double turn_deg, WrFrame *frame,
                        WrError *err)
{
    WrProgressPart part;
    const WrProgress *whole = wr_progress_enter(&part, 0.0, 0.8);
    bool good = wr_session_frame(session, width, height, turn_deg, frame, err);
    wr_progress_set(whole);
    return good;
}

/* Whether a file can be written there, before a long computation. */
static bool check_target(const char *path, WrError *err)
{
    WrFileTarget target = { 0 };
    if (!wr_file_begin(&target, path, err)) return false;
    wr_file_abort(&target);
    return true;
}

bool wr_session_render(WrSession *session, const char *path, int width, int height, double turn_deg,
                       WrError *err)
{
    char buffer[16];
    const char *ending = wr_path_ending(path, buffer);
    bool linear =
        strcmp(ending, "exr") == 0 || strcmp(ending, "tif") == 0 || strcmp(ending, "tiff") == 0;
    WrFrame frame;
    if (!wr_image_can_write(path, linear ? WR_PIXEL_F32 : WR_PIXEL_U8, linear ? 4 : 3, linear, err))
        return false;
    if (!check_target(path, err)) return false;
    if (!frame_first(session, width, height, turn_deg, &frame, err)) return false;
    if (session->state.document->scene->tolerance.kind != WR_TOLERANCE_NONE &&
        session->choice.count > 0 && !session->choice.met && !session->choice.told) {
        wr_session_note(session, "%s: %s", path, session->choice.reason);
        session->choice.told = true;
    }
    WrProgressPart part;
    const WrProgress *whole = wr_progress_enter(&part, 0.8, 1.0);
    bool good = linear ? wr_image_write_pixels(path, frame.width, frame.height, 4, WR_PIXEL_F32,
                                               true, frame.rgba, err)
                       : write_codes(session, path, &frame, err);
    wr_progress_set(whole);
    return good;
}

static bool run_render(WrSession *session, WrCall *call, WrError *err)
{
    const double *size = wr_call_arg(call, "size")->numbers;
    return wr_session_render(session, wr_call_arg(call, "FILE")->text, (int)size[0], (int)size[1],
                             0, err);
}

/* ---- documents ---- */

/* Up to date, so that what follows need not wait for it. */
static bool make_composite(WrSession *session, WrError *err)
{
    wr_document_composite(session->state.document, session->options.pool);
    return !wr_progress_stopped() || wr_fail(err, "cancelled");
}

/* Do both names lead to one file? */
static bool same_file(const char *a, const char *b)
{
    struct stat first, second;
    return stat(a, &first) == 0 && stat(b, &second) == 0 && first.st_dev == second.st_dev &&
           first.st_ino == second.st_ino;
}

bool wr_session_save(WrSession *session, const char *path, WrError *err)
{
    WrText text = { 0 };
    if (session->state.newer_path && same_file(session->state.newer_path, path))
        return wr_fail(err,
                       "%s: was saved by a newer version of the program: saving over it would lose "
                       "what this one does not know; choose another name",
                       path);
    if (!make_composite(session, err)) return false;
    wr_session_kept_text(session, &text);
    char ending[16];
    bool ora = strcmp(wr_path_ending(path, ending), "ora") == 0;
    bool good = (ora ? wr_ora_save : wr_document_save)(session->state.document, wr_text_get(&text),
                                                       path, err);
    wr_text_fini(&text);
    if (!good) return false;
    char *kept = wr_strdup(path); /* may be the old name itself */
    wr_free(session->state.path);
    session->state.path = kept;
    session->state.stamp = wr_file_stamp(kept);
    session->state.saved_revision = wr_session_revision(session);
    wr_session_journal_saved(session);
    return true;
}

static bool run_save(WrSession *session, WrCall *call, WrError *err)
{
    return wr_session_save(session, wr_call_arg(call, "FILE")->text, err);
}

/* ---- exports ---- */

static bool run_export(WrSession *session, WrCall *call, WrError *err)
{
    const WrExportKind *kind = &wr_export_kinds[call->form];
    WrExportOptions options = wr_export_default();
    for (int i = 0; i < call->count; i++)
        if (call->args[i].given && !call->specs[i].positional &&
            !wr_export_option(kind, &options, call->specs[i].name, call->args[i].text, err))
            return false;
    const char *path = wr_call_arg(call, "FILE")->text;
    WrExportReport report;
    if (!make_composite(session, err)) return false;
    if (!wr_export(kind, session->state.document, &options, session->options.pool, path, &report,
                   err))
        return false;
    WrText text = { 0 };
    wr_export_report_text(&report, &text);
    wr_session_note(session, "%s: %s", path, wr_text_get(&text));
    wr_text_fini(&text);
    return true;
}

static const WrArgSpec args_save[] = {
    { PLACE("FILE"), .type = WR_ARG_PATH,
      .help = "an OpenEXR file, *.exr, or an OpenRaster file, *.ora" },
    { 0 }
};

static bool check_export_option(const void *ctx, const char *name, const char *value, WrError *err)
{
    WrExportOptions options = wr_export_default();
    return wr_export_option(ctx, &options, name, value, err);
}

static bool form_export(int i, WrForm *out)
{
    if (i >= WR_EXPORT_KIND_COUNT) return false;
    const WrExportKind *kind = &wr_export_kinds[i];
    *out = (WrForm){ .name = kind->name, .help = kind->help };
    for (int k = 0; k < WR_EXPORT_OPTIONS && kind->options[k].name; k++)
        out->args[k] = (WrArgSpec){ .name = kind->options[k].name,
                                    .type = WR_ARG_TEXT,
                                    .shape = kind->options[k].values,
                                    .help = kind->options[k].help,
                                    .check = check_export_option,
                                    .check_ctx = kind };
    return true;
}

static const WrArgSpec args_export[] = {
    { PLACE("FILE"), .type = WR_ARG_PATH, .help = "the format goes by its ending" }, { 0 }
};

static const WrArgSpec args_render[] = {
    { PLACE("FILE"), .type = WR_ARG_PATH,
      .help = "exr and tiff hold linear float with coverage, others 8-bit sRGB" },
    { .name = "size",
      .type = WR_ARG_SIZE,
      .low = 1,
      .high = 16384,
      .fallback = NUMBERS(512, 512),
      .unit = "pixels",
      .help = "of the picture" },
    { 0 }
};

/* ---- the rows ---- */

const WrCommand wr_command_save = { .name = "save",
                                    .kind = WR_CLASS_OUTPUT,
                                    .args = args_save,
                                    .run = run_save,
                                    .help = "save the document",
                                    .example = "save bricks.exr" };

const WrCommand wr_command_export = { .name = "export",
                                      .kind = WR_CLASS_OUTPUT,
                                      .form_word = "KIND",
                                      .form = form_export,
                                      .args = args_export,
                                      .run = run_export,
                                      .help = "write the table for other programs",
                                      .example = "export height bricks.png" };

const WrCommand wr_command_render = { .name = "render",
                                      .kind = WR_CLASS_OUTPUT,
                                      .args = args_render,
                                      .run = run_render,
                                      .help = "write a picture of the scene",
                                      .example = "render bricks.png size=640x480" };
