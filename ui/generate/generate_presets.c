/* Presets of generators, in presets.wrinkle in the settings folder: the name as a comment, the command below, so that
   the file is also a script. Unknown lines are kept. */
#include "ui/state/app_state.h"
#include "ui/state/messages.h"
#include "ui/state/settings.h"
#include "ui/generate/generate_state.h"

#include "base/array.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "command/command_line.h"
#include "command/generate.h"
#include "generate/generator.h"
#include "system/path.h"

#include <SDL.h>
#include <string.h>

#define FILE_MAX (1 << 22) /* bytes */

static void forget(WrGenerateState *hand)
{
    for (int i = 0; i < hand->presets.count; i++) {
        wr_free(hand->presets.data[i].name);
        wr_free(hand->presets.data[i].line);
    }
    hand->presets.count = 0;
}

static const WrGenerator *generator_of(const char *line)
{
    WrCall *call = NULL;
    WrError err;
    const WrGenerator *generator =
        wr_call_parse(line, false, &call, &err) && call->command ? wr_call_generator(call) : NULL;
    wr_call_free(call);
    return generator;
}

static void parse(WrGenerateState *hand, const char *text)
{
    char *name = NULL;
    while (*text) {
        size_t length = strcspn(text, "\r\n");
        char *line = wr_strndup(text, length);
        text += length + (text[length] != '\0');
        if (line[0] == '#') {
            wr_free(name);
            name = wr_strdup(line + strspn(line, "# "));
            name[strlen(name) < WR_GENERATE_NAME ? strlen(name) : WR_GENERATE_NAME - 1] = '\0';
        } else if (line[0] && name && hand->presets.count < WR_GENERATE_PRESETS) {
            wr_array_push(&hand->presets, ((WrGeneratePreset){ name, line, generator_of(line) }));
            name = line = NULL;
        }
        wr_free(line);
    }
    wr_free(name);
}

/* Read the file again, since another window may have added presets. False: it exists but is unreadable. */
static bool read_file(WrApp *app, WrError *err)
{
    char *path = wr_config_path("presets.wrinkle"), *bytes = NULL;
    size_t length;
    bool there = path && wr_path_is_there(path);
    bool good = !there || wr_file_read(path, FILE_MAX, &bytes, &length, err);
    if (good) {
        forget(app->generate);
        if (bytes) parse(app->generate, bytes);
    }
    wr_free(bytes);
    wr_free(path);
    return good;
}

static bool write_file(WrApp *app, WrError *err)
{
    const WrGenerateState *hand = app->generate;
    char *path = wr_config_path("presets.wrinkle");
    WrText text = { 0 };
    for (int i = 0; i < hand->presets.count; i++)
        wr_text_addf(&text, "# %s\n%s\n", hand->presets.data[i].name, hand->presets.data[i].line);
    bool good = path ? true : wr_fail(err, "no folder for settings: HOME is not set");
    if (good) wr_settings_make_folder();
    good = good && wr_file_write(path, wr_text_get(&text), text.length, err);
    wr_text_fini(&text);
    wr_free(path);
    return good;
}

void wr_generate_presets_find(WrApp *app)
{
    WrError err;
    if (app->generate->presets_known) return;
    app->generate->presets_known = true;
    if (!read_file(app, &err)) wr_app_fail(app, &err);
}

static int find(const WrGenerateState *hand, const WrGenerator *generator, const char *name)
{
    for (int i = 0; i < hand->presets.count; i++)
        if (hand->presets.data[i].generator == generator &&
            strcmp(hand->presets.data[i].name, name) == 0)
            return i;
    return -1;
}

/* Trim blanks and a leading #; control characters become blanks. */
static bool tidy(const char *name, char out[WR_GENERATE_NAME])
{
    SDL_utf8strlcpy(out, name + strspn(name, " #\t"), WR_GENERATE_NAME);
    for (char *c = out; *c; c++)
        if ((unsigned char)*c < ' ' || *c == 0x7f) *c = ' ';
    for (size_t n = strlen(out); n > 0 && out[n - 1] == ' '; n--) out[n - 1] = '\0';
    return out[0] != '\0';
}

bool wr_generate_preset_taken(const WrApp *app, const char *name)
{
    char own[WR_GENERATE_NAME];
    return tidy(name, own) && find(app->generate, app->generate->generator, own) >= 0;
}

bool wr_generate_preset_save(WrApp *app, const char *name)
{
    WrGenerateState *hand = app->generate;
    WrError err;
    WrText line = { 0 };
    char own[WR_GENERATE_NAME];
    if (!hand->generator || !tidy(name, own)) return false;
    wr_generate_line(hand, &line);
    bool good = generator_of(wr_text_get(&line)) == hand->generator
                    ? read_file(app, &err)
                    : wr_fail(&err, "this cannot be made yet: the panel shows why");
    int i = good ? find(hand, hand->generator, own) : -1;
    if (good && i < 0 && hand->presets.count >= WR_GENERATE_PRESETS)
        good = wr_fail(&err, "there are %d presets: delete one first", WR_GENERATE_PRESETS);
    if (good && i < 0) {
        wr_array_push(&hand->presets,
                      ((WrGeneratePreset){ wr_strdup(own), NULL, hand->generator }));
        i = hand->presets.count - 1;
    }
    if (good) {
        wr_free(hand->presets.data[i].line);
        hand->presets.data[i].line = wr_strdup(wr_text_get(&line));
        hand->preset = i;
        good = write_file(app, &err);
    }
    if (!good) wr_app_fail(app, &err);
    wr_text_fini(&line);
    return good;
}

bool wr_generate_preset_delete(WrApp *app, int index)
{
    WrGenerateState *hand = app->generate;
    WrError err;
    if (index < 0 || index >= hand->presets.count) return false;
    char *name = wr_strdup(hand->presets.data[index].name);
    const WrGenerator *generator = hand->presets.data[index].generator;
    bool good = read_file(app, &err);
    int i = good ? find(hand, generator, name) : -1;
    wr_free(name);
    if (i >= 0) {
        WrGeneratePreset *list = hand->presets.data;
        wr_free(list[i].name);
        wr_free(list[i].line);
        memmove(list + i, list + i + 1, (size_t)(hand->presets.count - i - 1) * sizeof *list);
        hand->presets.count--;
        good = write_file(app, &err);
    }
    hand->preset = -2;
    if (!good) wr_app_fail(app, &err);
    return good;
}
