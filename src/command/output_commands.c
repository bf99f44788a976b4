/* Output commands: save, export, render, maps, and the settings of the export sheet. */
#include "base/array.h"
#include "base/enum_rows.h"
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
#include "export/map_sets.h"
#include "export/receipt.h"
#include "scene/scene.h"
#include "system/clock.h"
#include "system/path.h"

#include <stdio.h>
#include <string.h>

/* ---- Output commands: save, export, render ---- */

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
            return wr_fail(err, "%s= is only for several frames: give frames=N too", of_frames[i]);
    return wr_session_render(session, wr_call_arg(call, "FILE")->text, (int)size[0], (int)size[1],
                             NULL, wr_call_arg(call, "turn")->numbers[0], err);
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
                       "data unknown to this version; choose another name",
                       path);
    const double began = wr_clock_seconds();
    if (!make_composite(session, err)) return false;
    wr_session_kept_text(session, &text);
    char ending[16];
    bool ora = strcmp(wr_path_ending(path, ending), "ora") == 0;
    WrText note = { 0 };
    bool good = ora ? wr_ora_save(session->state.document, wr_text_get(&text), path, &note, err)
                    : wr_document_save(session->state.document, wr_text_get(&text), path,
                                       session->options.pool, err);
    wr_text_fini(&text);
    if (note.length) wr_session_note(session, "%s", note.data);
    wr_text_fini(&note);
    if (!good) return false;
    wr_session_receipt(session, path, "document", NULL, began);
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
    char *path = wr_session_output_name(session, wr_call_arg(call, "FILE")->text, err);
    WrExportReport report;
    const double began = wr_clock_seconds();
    const bool good = path && wr_session_check_export(session, kind, path, err) &&
                      make_composite(session, err) &&
                      wr_export(kind, session->state.document, &options, session->options.pool,
                                path, &report, err);
    WrText text = { 0 };
    if (good) wr_export_report_text(&report, &text);
    if (good) wr_session_note(session, "%s: %s", path, wr_text_get(&text));
    if (good) wr_session_receipt(session, path, kind->name, &report, began);
    wr_text_fini(&text);
    wr_free(path);
    return good;
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
    { PLACE("FILE"), .type = WR_ARG_PATH, .help = "output file; its extension chooses the format" },
    { 0 }
};

static const WrArgSpec args_render[] = {
    { PLACE("FILE"), .type = WR_ARG_PATH,
      .help =
          "output file; exr and tiff store linear floats with coverage, other formats 8-bit sRGB" },
    { .name = "size",
      .type = WR_ARG_SIZE,
      .low = 1,
      .high = 16384,
      .fallback = NUMBERS(512, 512),
      .unit = "pixels",
      .help = "size of the picture" },
    { .name = "turn",
      .type = WR_ARG_NUMBER,
      .low = -1e6,
      .high = 1e6,
      .fallback = NUMBERS(0),
      .unit = "degrees",
      .help = "turn of the objects about the world's y axis" },
    { .name = "frames",
      .type = WR_ARG_NUMBER,
      .low = 1,
      .high = 100000,
      .whole = true,
      .help = "number of frames of a turntable: a film (gif, apng, webp or mp4), or files with "
              "#### in FILE replaced by the frame number; each frame is turned by step= more than "
              "the one before" },
    { .name = "step",
      .type = WR_ARG_NUMBER,
      .low = -1e6,
      .high = 1e6,
      .fallback = NUMBERS(0),
      .unit = "degrees",
      .help = "turn per frame; left out, one full turn over all frames" },
    { .name = "fps",
      .type = WR_ARG_NUMBER,
      .low = 0.1,
      .high = 240,
      .fallback = NUMBERS(25),
      .help = "frames per second of a film" },
    { .name = "loop",
      .type = WR_ARG_NUMBER,
      .low = 0,
      .high = 65535,
      .whole = true,
      .fallback = NUMBERS(0),
      .help = "repetitions of a film; 0: endless" },
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
                                      .of_variants = true,
                                      .help = "export the table for other programs",
                                      .example = "export height bricks.png" };

const WrCommand wr_command_render = { .name = "render",
                                      .kind = WR_CLASS_OUTPUT,
                                      .args = args_render,
                                      .run = run_render,
                                      .of_variants = true,
                                      .help = "render a picture of the scene, or a turntable",
                                      .example = "render bricks.png size=640x480" };

/* ---- The command maps: a set of map files for another program ---- */

/* Words passed on to the maps: all arguments except the names. */
typedef struct Words {
    char *words[WR_MAP_SET_WORDS_MAX + 1]; /* owned */
    int count;
} Words;

static void take_words(const WrCall *call, Words *out)
{
    for (int i = 0; i < call->count && out->count <= WR_MAP_SET_WORDS_MAX; i++) {
        if (!call->args[i].given || call->specs[i].positional ||
            strcmp(call->specs[i].name, "name") == 0)
            continue;
        WrText word = { 0 };
        wr_text_addf(&word, "%s=%s", call->specs[i].name, call->args[i].text);
        out->words[out->count++] = word.data;
    }
}

static bool run_set(WrSession *session, const WrCall *call, const WrMapSet *set, WrError *err)
{
    Words words = { 0 };
    WrText name = { 0 }, list = { 0 };
    WrReceipts receipts = { 0 };
    if (wr_call_given(call, "name")) wr_text_add(&name, wr_call_arg(call, "name")->text);
    else wr_map_set_cell_name(session->state.path, &name);
    take_words(call, &words);
    const WrMapSetRequest order = { .set = set,
                                    .folder = wr_call_arg(call, "FOLDER")->text,
                                    .name = wr_text_get(&name),
                                    .words = (const char *const *)words.words,
                                    .word_count = words.count,
                                    .receipts = &receipts };
    bool good =
        wr_export_map_set(&order, session->state.document, session->options.pool, &list, err);
    for (const char *at = wr_text_get(&list); good && *at;) {
        const size_t length = strcspn(at, "\n");
        wr_session_note(session, "%.*s", (int)length, at);
        at += length + (at[length] == '\n');
    }
    for (int i = 0; good && session->options.receipt && i < receipts.files.count; i++)
        session->options.receipt(session->options.receipt_ctx, &receipts.files.data[i]);
    wr_receipts_free(&receipts);
    for (int i = 0; i < words.count; i++) wr_free(words.words[i]);
    wr_text_fini(&name);
    wr_text_fini(&list);
    return good;
}

static bool run_maps(WrSession *session, WrCall *call, WrError *err)
{
    WrMapSet *set = wr_map_set_find(wr_call_arg(call, "SET")->text, err);
    if (!set) return false;
    bool good = wr_document_whole(session->state.document, session->options.pool, err) &&
                (!wr_progress_stopped() || wr_fail(err, "cancelled")) &&
                run_set(session, call, set, err);
    wr_map_set_free(set);
    return good;
}

/* Accept a value that any kind of map accepts; the kinds of the set are checked when they are written. */
static bool check_word(const void *ctx, const char *name, const char *value, WrError *err)
{
    (void)ctx;
    for (int i = 0; i < WR_EXPORT_KIND_COUNT; i++)
        for (const WrExportOptionInfo *o = wr_export_kinds[i].options; o->name; o++) {
            WrExportOptions options = wr_export_default();
            if (strcmp(o->name, name) == 0 && o->set(&options, value, err)) return true;
        }
    return false;
}

/* All options of all kinds, each once. */
static bool row_maps(WrForm *out)
{
    int count = 0;
    *out = (WrForm){ 0 };
    for (int i = 0; i < WR_EXPORT_KIND_COUNT; i++)
        for (const WrExportOptionInfo *o = wr_export_kinds[i].options; o->name; o++) {
            bool there = false;
            for (int k = 0; k < count; k++) there |= strcmp(out->args[k].name, o->name) == 0;
            if (there || count == WR_ARGS_MAX - 1) continue;
            out->args[count++] = (WrArgSpec){ .name = o->name,
                                              .type = o->named ? WR_ARG_NAME : WR_ARG_TEXT,
                                              .shape = o->values,
                                              .check = check_word,
                                              .help = "settings of the maps that have them" };
        }
    return true;
}

static const WrArgSpec args_maps[] = {
    { PLACE("SET"), .type = WR_ARG_NAME,
      .help = "set of maps: blender, unreal and so on, or one of your own" },
    { PLACE("FOLDER"), .type = WR_ARG_PATH,
      .help = "existing folder; either all files are written or none" },
    { .name = "contact",
      .type = WR_ARG_NAME,
      .help = "on: also write contact.png, an overview of all maps with their names" },
    { .name = "material",
      .type = WR_ARG_NAME,
      .shape = "FORMAT,... or all or none",
      .help = "material files to write beside the maps: mtlx (MaterialX), usda (USD), gltf; left "
              "out, those of the set" },
    { .name = "name",
      .type = WR_ARG_NAME,
      .help = "name of the cell in the file names; left out, the document's" },
    { .name = "udim",
      .type = WR_ARG_NAME,
      .shape = "NUMBER or none",
      .help = "UDIM tile in the file names, NAME_normal.1002.png; left out, that of the object's "
              "mesh (`surface mesh udim=`)" },
    { 0 }
};

const WrCommand wr_command_maps = {
    .name = "maps",
    .kind = WR_CLASS_OUTPUT,
    .row = row_maps,
    .args = args_maps,
    .run = run_maps,
    .of_variants = true,
    .help = "export a set of maps for another program",
    .details = "Sets: " WR_MAP_SET_NAMES
               ", and your own, files NAME.set in the folder sets of your settings. Each file is "
               "read back; either all files are written or none.",
    .example = "maps unreal . name=bricks"
};

/* ---- The command sheet: stored settings of the export sheet ---- */

WR_ROWS(depths);
static const char *const depths[WR_SHEET_DEPTHS + 1] = { [WR_ROW(WR_SHEET_AS_SET)] = "set",
                                                         [WR_ROW(WR_SHEET_8)] = "8",
                                                         [WR_ROW(WR_SHEET_16)] = "16",
                                                         [WR_ROW(WR_SHEET_FLOAT)] = "32" };
static const char *const sizes[WR_SHEET_SIZES + 1] = { "table", "half", "quarter", "power" };
static const char *const ranges[WR_SHEET_RANGES + 1] = { "set", "auto", "unit", "signed" };

/* Limits the length of a text; ctx holds the limit in bytes. */
static bool check_length(const void *ctx, const char *name, const char *value, WrError *err)
{
    const size_t most = *(const size_t *)ctx;
    if (strlen(value) < most) return true;
    return wr_fail(err, "%s: %zu bytes: at most %zu", name, strlen(value), most - 1);
}

static void print_sheet(const WrScene *scene, WrText *text)
{
    const WrSheetRequest *sheet = &scene->sheet;
    if (!*sheet->as) return;
    wr_text_add(text, "sheet ");
    wr_text_add_word(text, sheet->as);
    if (*sheet->folder) wr_text_add(text, " folder="), wr_text_add_word(text, sheet->folder);
    if (*sheet->name) wr_text_add(text, " name="), wr_text_add_word(text, sheet->name);
    wr_text_addf(text, " depth=%s size=%s range=%s\n", depths[sheet->depth], sizes[sheet->size],
                 ranges[sheet->range]);
}

static void take(const WrCall *call, const char *name, char *to, size_t size)
{
    const WrArg *arg = wr_call_arg(call, name);
    snprintf(to, size, "%s", arg->given ? arg->text : "");
}

static bool run_sheet(WrSession *session, WrCall *call, WrError *err)
{
    (void)err;
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    WrSheetRequest *sheet = &scene->sheet;
    take(call, "SET", sheet->as, sizeof sheet->as);
    take(call, "folder", sheet->folder, sizeof sheet->folder);
    take(call, "name", sheet->name, sizeof sheet->name);
    sheet->depth = wr_call_choice(call, "depth");
    sheet->size = wr_call_choice(call, "size");
    sheet->range = wr_call_choice(call, "range");
    wr_session_replace_scene(session, scene);
    return true;
}

static const size_t most_word = WR_SHEET_WORD, most_folder = WR_SHEET_FOLDER,
                    most_name = WR_SHEET_NAME;

static const WrArgSpec args_sheet[] = {
    { PLACE("SET"), .type = WR_ARG_NAME, .shape = "SET or KIND", .check = check_length,
      .check_ctx = &most_word, .help = "a set of `maps`, or a kind of `export`" },
    { .name = "folder",
      .type = WR_ARG_PATH,
      .shape = "FOLDER",
      .check = check_length,
      .check_ctx = &most_folder,
      .help = "folder; left out, the document's" },
    { .name = "name",
      .type = WR_ARG_NAME,
      .shape = "NAME",
      .check = check_length,
      .check_ctx = &most_name,
      .help = "name of the cell in the file names; left out, the document's" },
    { .name = "depth",
      .type = WR_ARG_CHOICE,
      .words = depths,
      .fallback_text = "set",
      .help = "bits per channel; set: as the set defines" },
    { .name = "size",
      .type = WR_ARG_CHOICE,
      .words = sizes,
      .fallback_text = "table",
      .help =
          "size in texels: the table's, half or a quarter of it, or the nearest powers of two" },
    { .name = "range",
      .type = WR_ARG_CHOICE,
      .words = ranges,
      .fallback_text = "set",
      .help = "range of heights in integer formats: as the set defines, the table's, 0 to 1, or "
              "symmetric about 0" },
    { 0 }
};

const WrCommand wr_command_sheet = {
    .name = "sheet",
    .kind = WR_CLASS_SCENE,
    .args = args_sheet,
    .run = run_sheet,
    .print = print_sheet,
    .help = "store the settings of the window's export dialog",
    .details = "The document stores them. This writes no files; `maps` does.",
    .example = "sheet unreal folder=out name=bricks depth=16"
};
