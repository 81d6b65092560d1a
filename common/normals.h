/* The normals of a height image, to be stored as a texture beside it. */
#ifndef TEXEL_NORMALS_H
#define TEXEL_NORMALS_H

#include "image.h"

/* Unit normals n_x, n_y, n_z at the texels of a height image (its first channel), three channels: central
 * differences over the neighbours, which wrap around, as in
 *     n = (-scale dh/dx, -scale dh/dy, 1) normalized,   dh/dx = (h(x + 1) - h(x - 1)) width / 2.
 * scale is the height's in texture widths, aspect the texture's height over its width in world units. The
 * caller destroys the image. */
Image height_normals(const Image *height, double scale, double aspect);

#endif
