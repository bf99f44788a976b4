#include "ui/app/state/plain_error.h"
#include "ui/app/state/action_list.h"
#include "ui/toolkit/words.h"

#include "command/command_table.h"

#include <stdio.h>
#include <string.h>

/* Formats of errors that are met by clicking and painting, and the sentences and actions shown for them. */
static const struct {
    const char *format, *plain;
    const char *actions[WR_PLAIN_ACTIONS];
} plains[] = {
    { "%s is locked: `layer set %d lock=off` unlocks it", "This layer is locked.", { NULL } },
    { "%s is hidden: `layer set %d visible=on` shows it",
      "This layer is hidden: changes to it would be invisible.",
      { NULL } },
    { "%s is not shown while layer %d is alone: `layer solo off` shows all",
      "Another layer is shown alone, so this one is invisible.",
      { NULL } },
    { "%s has a live mask: `layer mask %d live=off` converts it to one that can be painted on",
      "This mask is computed from its terms. Change them, or rasterize the mask to paint on it.",
      { WR_ACT(mask_live) } },
    { "%s is a group, which has no heights of its own: `layer use` one of its layers, or its mask",
      "This is a group. Paint on its mask, or choose one of its layers.",
      { WR_ACT(mask_edit), WR_ACT(mask_white), WR_ACT(layer_below) } },
    { "%s is a filter layer, which has no heights of its own: `layer use` another layer, or its "
      "mask",
      "This is a filter layer. Paint on its mask, or choose another layer.",
      { WR_ACT(mask_edit), WR_ACT(mask_white), WR_ACT(layer_below) } },
    { "%s is a generator layer: `layer set %d change=` changes its arguments, `layer rasterize %d` "
      "converts it to a layer that can be painted on",
      "This is a generator layer. Change its settings, or rasterize it to paint on it.",
      { WR_ACT(filter_edit) } },
    { "%s is hidden: only visible layers can be merged",
      "A hidden layer cannot be merged. Show it first.",
      { WR_ACT(layer_show) } },
    { "layer %d is a filter layer, which has no heights to clear",
      "This is a filter layer: it has no heights to clear.",
      { NULL } },
    { "layer %d is a group, which has no heights to clear",
      "This is a group: clear its layers one by one.",
      { NULL } },
    { "part=mask: layer %d has no mask: `layer mask %d from=white` adds one",
      "This layer has no mask yet.",
      { WR_ACT(mask_white) } },
    { "layer %d is already a plain layer: there is nothing to rasterize",
      "This layer is already a plain layer: there is nothing to rasterize.",
      { NULL } },
    { "the mesh has no texture coordinates to paint on: `surface mesh projection=box` computes "
      "them",
      "This mesh has no UVs to paint on. Choose a projection in Scene.",
      { NULL } },
    { "busy: another command is running", "Wait until the current work is done.", { NULL } },
};

static const char *after_verb(const char *message)
{
    static const char start[] = "\2%s: \37";
    const bool marked = strncmp(message, start, sizeof start - 1) == 0;
    const char *verb = marked ? message + sizeof start - 1 : message;
    const size_t length = strcspn(verb, marked ? "\3" : ":");
    char name[40];
    if (length >= sizeof name || verb[length] == '\0') return message;
    memcpy(name, verb, length);
    name[length] = '\0';
    if (!wr_command_find(name)) return message;
    if (marked) return verb + length + 1;
    return verb[length + 1] == ' ' ? verb + length + 2 : message;
}

/* Index of the row whose format begins the message, or -1. */
static int row_of(const char *message)
{
    for (size_t i = 0; *message == '\2' && i < sizeof plains / sizeof *plains; i++) {
        const size_t length = strlen(plains[i].format);
        const char end = message[1 + strcspn(message + 1, "\37\3")];
        if (end && strncmp(message + 1, plains[i].format, length) == 0 &&
            strcspn(message + 1, "\37\3") == length)
            return (int)i;
    }
    return -1;
}

void wr_plain_error(const char *message, char *out, size_t size)
{
    const char *rest = after_verb(message);
    const int row = row_of(rest);
    if (row >= 0) snprintf(out, size, "%s", wr_words(plains[row].plain));
    else wr_words_message(rest, out, size);
}

bool wr_plain_error_actions(const char *message, const char *actions[WR_PLAIN_ACTIONS])
{
    const int row = row_of(after_verb(message));
    for (int i = 0; i < WR_PLAIN_ACTIONS; i++)
        actions[i] = row >= 0 ? plains[row].actions[i] : NULL;
    return row >= 0;
}
