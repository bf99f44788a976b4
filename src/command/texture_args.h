/* texture_args.h - what commands that lay a picture over u and v have in common: where it is from, and how often it is laid.
   Layer 6, private to src/command. */
#pragma once
#include "command/args.h"
#include "command/command_line.h"

#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrImage WrImage;
typedef struct WrTextureSample WrTextureSample;
typedef struct WrSession WrSession;
typedef struct WrText WrText;

/* " FILE channel=... part=... sha256=... repeat=..."; named: with the file's name. */
void wr_print_laid(const WrTextureSample *laid, bool named, WrText *text);
bool wr_check_repeat(const void *ctx, const char *name, const char *value, WrError *err);
/* How often the line has it laid, if it says so. */
void wr_take_repeat(const WrCall *call, WrTextureSample *laid);
/* Another file's picture: laid as the table is, unless the line says otherwise. name NULL: none. */
void wr_take_laid(WrCall *call, const char *name, WrTextureSample *laid);
/* The picture that a line names: inside a document the one of that kind (WrObjectPicture) that it carries, else the file's.
 * The caller frees it. */
WrImage *wr_find_laid(WrSession *session, WrCall *call, const char *name, int which, WrError *err);
/* False and "WHY NAME=" where the line gives one of those names, the last of which is NULL. */
bool wr_refuse_without(const WrCall *call, const char *const *names, const char *why, WrError *err);

#define WR_ARGS_REPEAT                                                                             \
    {                                                                                              \
        .name = "repeat", .type = WR_ARG_TEXT, .shape = "table|once|ru,rv",                        \
        .check = wr_check_repeat,                                                                  \
        .help = "how often it is laid along u and v: as often as replicate says, like the table; " \
                "once; or so often. Left out: table"                                               \
    }
#define WR_ARGS_SHA256                                                                             \
    {                                                                                              \
        .name = "sha256", .type = WR_ARG_SHA256,                                                   \
        .help = "of the file: another content is then an error"                                    \
    }
