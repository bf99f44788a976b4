#include "generate/picture.h"

const WrGenerator wr_picture_rows[] = {
    { "picture", "photo", "Photo", "heights by how light a picture is", "replace", wr_params_photo,
      wr_picture_photo },
    { "picture", "normals", "Normal map",
      "the heights whose normals are nearest to those of a normal map", "replace",
      wr_params_normals, wr_picture_normals },
    { "picture", "paste", "Picture", "a picture as it is, at a place: what was copied, say",
      "replace", wr_params_paste, wr_picture_paste },
    { .family = NULL },
};
