/* The command sheet: stored settings of the export sheet. */
#include "base/error.h"
#include "base/enum_rows.h"
#include "base/text.h"
#include "command/args.h"
#include "command/commands.h"
#include "document/document.h"
#include "scene/scene.h"

#include <stdio.h>
#include <string.h>

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
      .check_ctx = &most_word, .help = "of `maps`, or a kind of `export`" },
    { .name = "folder",
      .type = WR_ARG_PATH,
      .shape = "FOLDER",
      .check = check_length,
      .check_ctx = &most_folder,
      .help = "left out: the document's" },
    { .name = "name",
      .type = WR_ARG_NAME,
      .shape = "NAME",
      .check = check_length,
      .check_ctx = &most_name,
      .help = "of the cell in the files' names; left out: the document's" },
    { .name = "depth",
      .type = WR_ARG_CHOICE,
      .words = depths,
      .fallback_text = "set",
      .help = "bits of a number, or as the set has it" },
    { .name = "size",
      .type = WR_ARG_CHOICE,
      .words = sizes,
      .fallback_text = "table",
      .help = "texels: the table's, half or a quarter of that, the nearest powers of two" },
    { .name = "range",
      .type = WR_ARG_CHOICE,
      .words = ranges,
      .fallback_text = "set",
      .help = "of heights in codes: as the set has it, the table's, 0 to 1, 0 in the middle" },
    { 0 }
};

const WrCommand wr_command_sheet = {
    .name = "sheet",
    .kind = WR_CLASS_SCENE,
    .args = args_sheet,
    .run = run_sheet,
    .print = print_sheet,
    .help = "what the export sheet of the window was told last",
    .details = "The document keeps it; nothing is written by it: `maps` does that.",
    .example = "sheet unreal folder=out name=bricks depth=16"
};
