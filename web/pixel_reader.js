// The values of a loaded picture's pixels.

export class PixelReader {
  #image;
  #context = null;

  /** `image` is an <img> from the same origin or a data: URI. */
  constructor(image) {
    this.#image = image;
  }

  /** [red, green, blue, alpha] in 0..255, or null while it is not loaded or (x, y) is outside. */
  read(x, y) {
    const { naturalWidth: width, naturalHeight: height } = this.#image;
    if (!this.#image.complete || width === 0 || x < 0 || y < 0 || x >= width || y >= height) return null;
    if (!this.#context) {
      const canvas = document.createElement("canvas");
      canvas.width = width;
      canvas.height = height;
      this.#context = canvas.getContext("2d", { willReadFrequently: true });
      this.#context.drawImage(this.#image, 0, 0);
    }
    return Array.from(this.#context.getImageData(x, y, 1, 1).data);
  }
}
