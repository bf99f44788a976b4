/* explain_map.h - where each effect ran, as a picture in false colours and its legend.
   Layer 7, private to src/cli. */
#pragma once
#include <stdbool.h>

typedef struct WrCli WrCli;
typedef struct WrError WrError;
typedef struct WrHeatmapCounts WrHeatmapCounts;
typedef struct WrSession WrSession;
typedef struct WrText WrText;

/* Is cli->map a name that such a picture can have? */
bool wr_map_check(const WrCli *cli, WrError *err);
/* Draw the session's picture, and write what each of its pixels took to cli->map. */
bool wr_map_write(const WrCli *cli, WrSession *session, WrHeatmapCounts *counts, WrError *err);
/* A line, or an element of an array, for each colour that is there. */
void wr_map_legend(const WrHeatmapCounts *counts, WrText *text);
void wr_map_legend_json(const WrHeatmapCounts *counts, WrText *text);
