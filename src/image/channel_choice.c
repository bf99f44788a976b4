#include "image/channel_choice.h"

#include "base/error.h"
#include "base/text.h"
#include "image/image.h"

#include <string.h>

/* Length of the layer name: 7 for "diffuse.R", whose own name is "R". */
static int layer_length(const char *name)
{
    const char *dot = strrchr(name, '.');
    return dot ? (int)(dot - name) : 0;
}

static const char *own_name(const char *name)
{
    const int length = layer_length(name);
    return length > 0 ? name + length + 1 : name;
}

/* The channel with that layer (`length` letters of `layer`) and own name, or -1. */
static int find_in_layer(const WrImagePart *part, const char *layer, int length, const char *own)
{
    for (int c = 0; c < part->channels; c++) {
        const char *name = part->channel_names[c];
        if (layer_length(name) == length && strncmp(name, layer, (size_t)length) == 0 &&
            wr_text_same_letters(own_name(name), own))
            return c;
    }
    return -1;
}

/* R, G, B, A of a layer; X, Y, Z, which is one vector (Blender's normals and positions); or Y, A. */
static bool take_layer(const WrImagePart *part, const char *layer, int length, WrChannelChoice *out)
{
    static const char *const sets[3][4] = { { "R", "G", "B", NULL },
                                            { "X", "Y", "Z", NULL },
                                            { "Y", NULL } };
    for (int set = 0; set < 3; set++) {
        WrChannelChoice choice = { 0 };
        bool all = true;
        for (int k = 0; sets[set][k] && all; k++) {
            const int c = find_in_layer(part, layer, length, sets[set][k]);
            all = c >= 0;
            choice.index[choice.count++] = c;
        }
        if (!all) continue;
        const int alpha = find_in_layer(part, layer, length, "A");
        if (alpha >= 0) choice.index[choice.count++] = alpha;
        *out = choice;
        return true;
    }
    return false;
}

/* True for the channel names of formats without names: then the first channels are the image. */
static bool nameless(const WrImagePart *part)
{
    for (int c = 0; c < part->channels; c++) {
        const char *name = part->channel_names[c];
        if (strchr(name, '.') || wr_text_same_letters(name, "z") ||
            wr_text_same_letters(name, "depth"))
            return false;
    }
    return part->channels <= 4;
}

static void choose_first(const WrImagePart *part, WrChannelChoice *choice)
{
    *choice = (WrChannelChoice){ .count = 1 };
    if (nameless(part)) {
        choice->count = part->channels;
        for (int c = 0; c < part->channels; c++) choice->index[c] = c;
        return;
    }
    if (take_layer(part, "", 0, choice)) return;
    for (int c = 0; c < part->channels; c++) {
        const char *name = part->channel_names[c];
        if (take_layer(part, name, layer_length(name), choice)) return;
    }
}

static void list(const WrImagePart *part, WrText *text)
{
    enum { MOST = 24 };
    for (int c = 0; c < part->channels && c < MOST; c++)
        wr_text_addf(text, "%s%.40s", c ? ", " : "", part->channel_names[c]);
    if (part->channels > MOST) wr_text_addf(text, " and %d more", part->channels - MOST);
}

/* "a,b", each by its full name. */
static bool take_several(const WrImagePart *part, const char *names, WrChannelChoice *out)
{
    WrChannelChoice choice = { 0 };
    for (const char *at = names; *at;) {
        const size_t length = strcspn(at, ",");
        int c = 0;
        while (c < part->channels &&
               (strncmp(part->channel_names[c], at, length) != 0 || part->channel_names[c][length]))
            c++;
        if (c == part->channels || choice.count == 4) return false;
        choice.index[choice.count++] = c;
        at += length + (at[length] == ',');
    }
    *out = choice;
    return true;
}

bool wr_channels_choose(const WrImagePart *part, const char *channel, WrChannelChoice *choice,
                        WrError *err)
{
    if (!channel || !*channel) {
        choose_first(part, choice);
        return true;
    }
    for (int c = 0; c < part->channels; c++)
        if (strcmp(part->channel_names[c], channel) == 0) {
            *choice = (WrChannelChoice){ .count = 1, .index = { c } };
            return true;
        }
    if (take_layer(part, channel, (int)strlen(channel), choice)) return true;
    if (strchr(channel, ',') && take_several(part, channel, choice)) return true;
    WrText names = { 0 };
    list(part, &names);
    wr_fail(err, "channel '%.60s': there is no such; there are %.140s", channel,
            wr_text_get(&names));
    wr_text_fini(&names);
    return false;
}

void wr_channels_report(const WrImagePart *part, const WrChannelChoice *choice, WrText *text)
{
    if (choice->count == part->channels) return;
    for (int k = 0; k < choice->count; k++)
        wr_text_addf(text, "%s%.40s", k ? ", " : "", part->channel_names[choice->index[k]]);
    wr_text_add(text, " of its channels ");
    list(part, text);
}
