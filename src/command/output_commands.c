/* Output commands: save, export, render. */
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/enum_rows.h"
#include "base/text.h"
#include "command/args.h"
#include "command/commands.h"
#include "document/document.h"
#include "document/document_file.h"
#include "document/ora.h"
#include "export/export.h"
#include "system/path.h"

#include <string.h>

/* ---- pictures ---- */

static bool run_turntable(WrSession *session, WrCall *call, WrError *err)
{
    const double *size = wr_call_arg(call, "size")->numbers;
    const double *frames = wr_call_arg(call, "frames")->numbers;
    WrTurntable turntable = wr_turntable_default();
    turntable.width = (int)size[0];
    turntable.height = (int)size[1];
    turntable.first = 1;
    turntable.last = (int)frames[0];
    turntable.turn_deg = wr_call_number(call, "turn");
    turntable.stepped = wr_call_given(call, "step");
    turntable.step_deg = wr_call_number(call, "step");
    if (wr_call_given(call, "fps")) turntable.fps = wr_call_number(call, "fps");
    if (wr_call_given(call, "loop")) turntable.loop = (int)wr_call_number(call, "loop");
    return wr_session_turntable(session, wr_call_arg(call, "FILE")->text, &turntable, err);
}

static bool run_render(WrSession *session, WrCall *call, WrError *err)
{
    static const char *const of_frames[] = { "step", "fps", "loop" };
    const double *size = wr_call_arg(call, "size")->numbers;
    if (wr_call_given(call, "frames")) return run_turntable(session, call, err);
    for (size_t i = 0; i < WR_LENGTH(of_frames); i++)
        if (wr_call_given(call, of_frames[i]))
            return wr_fail(err, "%s= is of several frames: say how many, frames=N", of_frames[i]);
    return wr_session_render(session, wr_call_arg(call, "FILE")->text, (int)size[0], (int)size[1],
                             wr_call_arg(call, "turn")->numbers[0], err);
}

/* ---- documents ---- */

/* Update the composite, so that the following work need not wait for it. */
static bool make_composite(WrSession *session, WrError *err)
{
    return wr_document_whole(session->state.document, session->options.pool, err) &&
           (!wr_progress_stopped() || wr_fail(err, "cancelled"));
}

/* True if both names refer to the same file. */
static bool same_file(const char *a, const char *b)
{
    WrFileInfo first, second;
    return wr_path_info(a, &first) && wr_path_info(b, &second) && first.device == second.device &&
           first.inode == second.inode;
}

bool wr_session_save(WrSession *session, const char *path, WrError *err)
{
    WrText text = { 0 };
    if (session->still) return wr_session_refuse_in_stroke(session, err);
    if (session->state.newer_path && same_file(session->state.newer_path, path))
        return wr_fail(err,
                       "%s: was saved by a newer version of the program: saving over it would lose "
                       "what this one does not know; choose another name",
                       path);
    if (!make_composite(session, err)) return false;
    wr_session_kept_text(session, &text);
    char ending[16];
    bool ora = strcmp(wr_path_ending(path, ending), "ora") == 0;
    WrText note = { 0 };
    bool good = ora ? wr_ora_save(session->state.document, wr_text_get(&text), path, &note, err)
                    : wr_document_save(session->state.document, wr_text_get(&text), path, err);
    wr_text_fini(&text);
    if (note.length) wr_session_note(session, "%s", note.data);
    wr_text_fini(&note);
    if (!good) return false;
    char *kept = wr_strdup(path); /* `path` may be the old name itself */
    wr_free(session->state.path);
    session->state.path = kept;
    session->state.stamp = wr_file_identity(kept);
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
                                    .type = kind->options[k].named ? WR_ARG_NAME : WR_ARG_TEXT,
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
    { .name = "turn",
      .type = WR_ARG_NUMBER,
      .low = -1e6,
      .high = 1e6,
      .fallback = NUMBERS(0),
      .unit = "degrees",
      .help = "of the object about the world's y axis" },
    { .name = "frames",
      .type = WR_ARG_NUMBER,
      .low = 1,
      .high = 100000,
      .whole = true,
      .help = "of a turntable: one film, gif, apng, webp or mp4, or files where "
              "#### in FILE becomes the frame's number; frame F is turned by F steps more" },
    { .name = "step",
      .type = WR_ARG_NUMBER,
      .low = -1e6,
      .high = 1e6,
      .fallback = NUMBERS(0),
      .unit = "degrees",
      .help = "a frame; left out: one turn over all of them" },
    { .name = "fps",
      .type = WR_ARG_NUMBER,
      .low = 0.1,
      .high = 240,
      .fallback = NUMBERS(25),
      .help = "of a film, frames a second" },
    { .name = "loop",
      .type = WR_ARG_NUMBER,
      .low = 0,
      .high = 65535,
      .whole = true,
      .fallback = NUMBERS(0),
      .help = "how often a film is played; 0: for ever" },
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
                                      .help = "write a picture of the scene, or a turntable",
                                      .example = "render bricks.png size=640x480" };
