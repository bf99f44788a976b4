/* Automatic names of generator layers: the generator's label and the first words of its text, or the name of its file. */
#include "ui/panels/generate/generate_state.h"
#include "ui/app/state/session_view.h"
#include "ui/toolkit/words.h"

#include "base/file.h"
#include "base/text.h"
#include "command/command_line.h"
#include "command/commands.h"
#include "document/document.h"
#include "document/object_tables.h"
#include "generate/generator.h"

#include <string.h>

#define LETTERS_MAX 24

/* The parameter that the layer is named after; NULL: none. */
static const WrParam *content_of(const WrGenerator *generator)
{
    const WrParam *p = generator->params;
    while (p->name && !p->positional) p++;
    const bool words = p->name && p->kind == WR_PARAM_TEXT && !p->path;
    return words || (p->name && p->kind == WR_PARAM_FILE) ? p : NULL;
}

/* Add one letter at `text`, a line's end as a space; returns the bytes read. */
static int add_letter(const char *text, WrText *out)
{
    if (text[0] == '\\' && text[1] == 'n') wr_text_add(out, " ");
    else if ((unsigned char)text[0] <= ' ') wr_text_add(out, " ");
    else wr_text_add_n(out, text, 1);
    if (text[0] == '\\' && text[1] == 'n') return 2;
    int count = 1;
    for (; ((unsigned char)text[count] & 0xC0) == 0x80; count++)
        wr_text_add_n(out, text + count, 1);
    return count;
}

/* Add whole words up to LETTERS_MAX letters, or of a longer word these letters. */
static void add_excerpt(const char *text, WrText *name)
{
    WrText out = { 0 };
    size_t words = 0; /* bytes up to the last space */
    int letters = 0;
    while (*text == ' ') text++;
    for (; *text && letters < LETTERS_MAX; letters++) {
        text += add_letter(text, &out);
        if (wr_text_get(&out)[out.length - 1] == ' ') words = out.length - 1;
    }
    const bool cut = *text && *text != ' ';
    wr_text_add_n(name, wr_text_get(&out), cut && words ? words : out.length);
    if (*text) wr_text_add(name, "…");
    wr_text_fini(&out);
}

/* False: the line is no generator's. */
static bool automatic_name(const char *line, WrText *name)
{
    WrCall *call = NULL;
    const WrGenerator *generator =
        line && wr_call_parse(line, false, &call, NULL) ? wr_call_generator(call) : NULL;
    const WrParam *content = generator ? content_of(generator) : NULL;
    const char *text = content ? wr_call_arg(call, content->name)->text : NULL;
    const char *slash = text && content->kind == WR_PARAM_FILE ? strrchr(text, '/') : NULL;
    if (generator) wr_text_add(name, wr_words(generator->label));
    if (text && *text) {
        wr_text_add(name, ": ");
        add_excerpt(slash ? slash + 1 : text, name);
    }
    wr_call_free(call);
    return generator;
}

/* Add `name`, or "NAME 2" and so on if another layer than `index` has it, as a word. */
static void add_free(const WrApp *app, int index, const char *base, WrText *command)
{
    WrText name = { 0 };
    wr_text_add(&name, base);
    for (int i = 2, found;
         (found = wr_layer_named(wr_app_document(app), wr_text_get(&name))) >= 0 && found != index;
         i++) {
        wr_text_clear(&name);
        wr_text_addf(&name, "%s %d", base, i);
    }
    wr_text_add_word(command, wr_text_get(&name));
    wr_text_fini(&name);
}

void wr_generate_add_name(const WrApp *app, const char *line, WrText *command)
{
    WrText name = { 0 };
    automatic_name(line, &name);
    add_free(app, -1, wr_text_get(&name), command);
    wr_text_fini(&name);
}

void wr_generate_follow_name(const WrApp *app, int index, const char *line, WrText *command)
{
    const WrLayer *layer = &wr_app_document(app)->layers[index];
    WrText was = { 0 }, name = { 0 };
    const bool known = automatic_name(layer->line, &was) && automatic_name(line, &name);
    const char *rest = layer->name + was.length;
    if (known && strcmp(wr_text_get(&was), wr_text_get(&name)) != 0 &&
        strncmp(layer->name, wr_text_get(&was), was.length) == 0 &&
        (!*rest ||
         (*rest == ' ' && rest[1] && strspn(rest + 1, "0123456789") == strlen(rest + 1)))) {
        wr_text_add(command, " name=");
        add_free(app, index, wr_text_get(&name), command);
    }
    wr_text_fini(&was);
    wr_text_fini(&name);
}
