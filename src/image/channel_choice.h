/* channel_choice.h - selection of the channels of an image part.
   Private to this module. */
#pragma once
#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrImagePart WrImagePart;
typedef struct WrText WrText;

typedef struct WrChannelChoice {
    int count;    /* 1..4 */
    int index[4]; /* of the part's channels */
} WrChannelChoice;

/* channel: a channel's name ("Depth.Z") or a layer's ("diffuse": its R, G, B, A or its Y); NULL or "":
 * the first layer with colours or grey, else the first channel. Errors: not found; the message lists
 * the existing ones. */
bool wr_channels_choose(const WrImagePart *part, const char *channel, WrChannelChoice *choice,
                        WrError *err);
/* Appends "diffuse.R, diffuse.G, diffuse.B of Z, diffuse.R, ..."; nothing if all channels are used. */
void wr_channels_report(const WrImagePart *part, const WrChannelChoice *choice, WrText *text);
