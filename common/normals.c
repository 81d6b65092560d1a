#include "normals.h"

/* The central difference between two neighbours that lie two of `texels` apart along one texture length. */
static double slope(const float *before, const float *after, int texels) {
    return ((double)*after - *before) * texels / 2.0;
}

Image height_normals(const Image *height, double scale, double aspect) {
    int columns = height->width, rows = height->height;
    Image normals = image_create(columns, rows, 3);
    for (int y = 0; y < rows; y++) {
        int below = y ? y - 1 : rows - 1, above = y + 1 < rows ? y + 1 : 0;
        for (int x = 0; x < columns; x++) {
            int left = x ? x - 1 : columns - 1, right = x + 1 < columns ? x + 1 : 0;
            double along_x = slope(image_at(height, left, y), image_at(height, right, y), columns);
            double along_y = slope(image_at(height, x, below), image_at(height, x, above), rows) / aspect;
            Vec3 normal = vec3_normalize(v3(-scale * along_x, -scale * along_y, 1.0));
            float *texel = image_at(&normals, x, y);
            texel[0] = (float)normal.x, texel[1] = (float)normal.y, texel[2] = (float)normal.z;
        }
    }
    return normals;
}
