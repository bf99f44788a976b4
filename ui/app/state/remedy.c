#include "ui/app/state/remedy.h"

#include "base/enum_rows.h"
#include "base/error.h"
#include "command/command_line.h"
#include "command/command_table.h"

#include <stdio.h>
#include <string.h>

/* The first row whose part is in the command names the button. Commands without a row are not offered: names and paths in a
   message come from files of others, and may contain commands in backquotes. */
static const struct {
    const char *part, *label;
} labels[] = {
    { "visible=on", "Show layer" },     { "lock=off", "Unlock layer" },
    { "solo off", "Show all layers" },  { "live=off", "Rasterize mask" },
    { "rasterize", "Rasterize layer" },
};

static const char *label_of(const char *line)
{
    if (strncmp(line, "layer ", 6) != 0) return NULL;
    for (int k = 0; k < WR_LENGTH(labels); k++)
        if (strstr(line, labels[k].part)) return labels[k].label;
    return NULL;
}

/* Writes no file, and is no step back in the history. */
static bool is_change(const char *line)
{
    WrCall *call = NULL;
    WrError err;
    if (!wr_call_parse(line, false, &call, &err)) return false;
    const bool change = call->command && wr_call_class(call) <= WR_CLASS_CHOICE;
    wr_call_free(call);
    return change;
}

/* The text is cut before the sentence's colon, so that nothing of the command language remains. */
static int length_before(const char *text, const char *quote)
{
    const char *colon = quote;
    while (colon > text && *colon != ':') colon--;
    if (colon == text) return (int)(quote - text);
    if (colon > text + 1 && strncmp(colon - 2, "\xc2\xa0", 2) == 0) colon -= 2; /* French */
    return (int)(colon - text);
}

bool wr_remedy_find(const char *text, WrRemedy *remedy)
{
    for (const char *from = strchr(text, '`'), *to; from && (to = strchr(from + 1, '`'));
         from = strchr(to + 1, '`')) {
        snprintf(remedy->line, sizeof remedy->line, "%.*s", (int)(to - from - 1), from + 1);
        if (to - from - 1 >= (int)sizeof remedy->line || !is_change(remedy->line)) continue;
        remedy->label = label_of(remedy->line);
        if (!remedy->label) continue;
        remedy->length = length_before(text, from);
        return true;
    }
    return false;
}
