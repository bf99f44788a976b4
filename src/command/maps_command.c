/* The command maps: a set of map files for another program. */
#include "base/array.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "command/args.h"
#include "command/commands.h"
#include "document/document.h"
#include "export/export.h"
#include "export/map_sets.h"

#include <string.h>

/* Words passed on to the maps: all arguments except the names. */
typedef struct Words {
    char *words[WR_SET_WORDS + 1]; /* owned */
    int count;
} Words;

static void take_words(const WrCall *call, Words *out)
{
    for (int i = 0; i < call->count && out->count <= WR_SET_WORDS; i++) {
        if (!call->args[i].given || call->specs[i].positional ||
            strcmp(call->specs[i].name, "name") == 0)
            continue;
        WrText word = { 0 };
        wr_text_addf(&word, "%s=%s", call->specs[i].name, call->args[i].text);
        out->words[out->count++] = word.data;
    }
}

static bool run_set(WrSession *session, const WrCall *call, const WrSet *set, WrError *err)
{
    Words words = { 0 };
    WrText name = { 0 }, told = { 0 };
    if (wr_call_given(call, "name")) wr_text_add(&name, wr_call_arg(call, "name")->text);
    else wr_set_cell_name(session->state.path, &name);
    take_words(call, &words);
    const WrSetOrder order = { .set = set,
                               .folder = wr_call_arg(call, "FOLDER")->text,
                               .name = wr_text_get(&name),
                               .words = (const char *const *)words.words,
                               .word_count = words.count };
    bool good = wr_export_set(&order, session->state.document, session->options.pool, &told, err);
    for (const char *at = wr_text_get(&told); good && *at;) {
        const size_t length = strcspn(at, "\n");
        wr_session_note(session, "%.*s", (int)length, at);
        at += length + (at[length] == '\n');
    }
    for (int i = 0; i < words.count; i++) wr_free(words.words[i]);
    wr_text_fini(&name);
    wr_text_fini(&told);
    return good;
}

static bool run_maps(WrSession *session, WrCall *call, WrError *err)
{
    WrSet *set = wr_set_find(wr_call_arg(call, "SET")->text, err);
    if (!set) return false;
    bool good = wr_document_whole(session->state.document, session->options.pool, err) &&
                (!wr_progress_stopped() || wr_fail(err, "cancelled")) &&
                run_set(session, call, set, err);
    wr_set_free(set);
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
                                              .help = "of those maps that have it" };
        }
    return true;
}

static const WrArgSpec args_maps[] = {
    { PLACE("SET"), .type = WR_ARG_NAME, .help = "blender, unreal and so on, or one of your own" },
    { PLACE("FOLDER"), .type = WR_ARG_PATH, .help = "that is there; all files or none" },
    { .name = "contact",
      .type = WR_ARG_NAME,
      .help = "a picture beside them that shows all, each with its name: contact.png" },
    { .name = "name",
      .type = WR_ARG_NAME,
      .help = "of the cell, in the files' names; left out: the document's" },
    { 0 }
};

const WrCommand wr_command_maps = {
    .name = "maps",
    .kind = WR_CLASS_OUTPUT,
    .row = row_maps,
    .args = args_maps,
    .run = run_maps,
    .help = "write the set of maps that another program wants",
    .details =
        "Sets: blender, gltf, unreal, unity, godot, substance, renderman, arnold, povray, and "
        "those "
        "of your own, files NAME.set in the folder sets of your settings. Each file is read back; "
        "then all take their places, or none.",
    .example = "maps unreal . name=bricks"
};
