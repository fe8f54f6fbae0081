package lensprof;

/** A part of a frame, px. */
public record Tile(int x, int y, int width, int height) {
}
