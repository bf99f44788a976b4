#include "scene/stock_model.h"

#define SIDES "projection=box cell=1,1 blend=0.4" /* cells of one unit on all sides */
#define FACES "projection=box cell=2,2 at=-1,-1,0"
#define DISC "projection=box cell=1.76,1.76 at=-0.88,-0.88,0" /* within the rim */

const WrStockModel wr_stock_models[WR_STOCK_MODELS] = {
    { "shader-ball",
      "Shader ball",
      "A ball with a groove on a foot: most angles at once",
      SIDES,
      { 12.75, -19.54, -4.33 } },
    { "rounded-cube", "Rounded cube", "A cube with round edges", SIDES, { 24, -32, -13 } },
    { "teapot", "Teapot", "Newell's teapot, 1975", SIDES, { 20.2, -26.52, -9.33 } },
    { "mug", "Mug", "A mug with a handle", SIDES, { 20.2, -26.52, -9.33 } },
    { "cloth", "Cloth", "A cloth that lies over a ball", SIDES, { 20.2, -26.52, -9.33 } },
    { "coin",
      "Coin",
      "A coin with a raised rim; the table once on each face",
      DISC,
      { 0, -22, 0 } },
    { "column", "Column", "A fluted column", SIDES, { 8, -18, -3 } },
    { "tile",
      "Tile",
      "A thick tile; the table once on its front",
      FACES,
      { 12.75, -19.54, -4.33 } },
    { "wall", "Wall", "A piece of wall", SIDES, { 12.75, -19.54, -4.33 } },
};
