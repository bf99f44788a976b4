/* illusion_run.h - `wrinkle accuracy --illusion`: error of bump mapping compared with displacement, and its map.
   Private to src/cli. */
#pragma once
#include <stdbool.h>

typedef struct WrCli WrCli;
typedef struct WrError WrError;
typedef struct WrLadderRequest WrLadderRequest;
typedef struct WrText WrText;

/* Check for conflicting options and a map that cannot be written. */
bool wr_illusion_check(const WrCli *cli, WrError *err);
/* Measure the picture of that request, write the map and append the result to text. name: of the document. */
bool wr_illusion_run(const WrCli *cli, const WrLadderRequest *request, const char *name,
                     WrText *text, WrError *err);
