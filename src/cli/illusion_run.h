/* illusion_run.h - `wrinkle accuracy --illusion`: what bump mapping lacks, and its map.
   Layer 8, private to the command line. */
#pragma once
#include <stdbool.h>

typedef struct WrCli WrCli;
typedef struct WrError WrError;
typedef struct WrLadderRequest WrLadderRequest;
typedef struct WrText WrText;

/* Options that do not go together, a map that cannot be written. */
bool wr_illusion_check(const WrCli *cli, WrError *err);
/* Measures the picture of that request, writes the map and adds the answer to text. name: of the document. */
bool wr_illusion_run(const WrCli *cli, const WrLadderRequest *request, const char *name,
                     WrText *text, WrError *err);
