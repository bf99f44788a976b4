/* texture_args.h - shared arguments of commands that map a picture over u and v: source file and tiling. Private to
   src/command. */
#pragma once
#include "command/args.h"
#include "command/command_line.h"

#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrImage WrImage;
typedef struct WrTextureSample WrTextureSample;
typedef struct WrSession WrSession;
typedef struct WrText WrText;

/* Print " FILE channel=... part=... sha256=... repeat=..."; named: with the file name. */
void wr_print_laid(const WrTextureSample *laid, bool named, WrText *text);
bool wr_check_repeat(const void *ctx, const char *name, const char *value, WrError *err);
/* Store the line's repeat= value, if given. */
void wr_take_repeat(const WrCall *call, WrTextureSample *laid);
/* Set the source to another file; tiling as the table's, unless the line has repeat=. name NULL: no picture. */
void wr_take_laid(WrCall *call, const char *name, WrTextureSample *laid);
/* The picture that a line names: while a document loads, its embedded picture of that kind (WrObjectPicture), else
 * the file's. The caller frees it. */
WrImage *wr_find_laid(WrSession *session, WrCall *call, const char *name, int which, WrError *err);
/* False and the error "WHY NAME=" if the line contains one of those names. The list ends with NULL. */
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
