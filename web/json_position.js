// Finds the value at a JSON pointer in a JSON text, so that an error can be shown in the text.

class Scanner {
  constructor(text) {
    this.text = text;
    this.at = 0;
    this.places = new Map();
  }

  space() {
    while (/\s/.test(this.text[this.at] ?? "")) ++this.at;
  }

  string() {
    const start = this.at++;
    while (this.at < this.text.length && this.text[this.at] !== '"') this.at += this.text[this.at] === "\\" ? 2 : 1;
    return JSON.parse(this.text.slice(start, ++this.at));
  }

  value(pointer) {
    this.space();
    const start = this.at;
    const first = this.text[this.at];
    if (first === "{" || first === "[") this.entries(pointer, first === "{");
    else if (first === '"') this.string();
    else while (this.at < this.text.length && !/[\s,\]}]/.test(this.text[this.at])) ++this.at;
    this.places.set(pointer, [start, this.at]);
  }

  entries(pointer, named) {
    ++this.at;
    for (let index = 0; ; ++index) {
      this.space();
      if (this.text[this.at] === "}" || this.text[this.at] === "]") break;
      let key = String(index);
      if (named) {
        key = this.string().replaceAll("~", "~0").replaceAll("/", "~1");
        this.space();
        ++this.at;
      }
      this.value(`${pointer}/${key}`);
      this.space();
      if (this.text[this.at] === ",") ++this.at;
    }
    ++this.at;
  }
}

/** [start, end) of the value, or of the nearest enclosing part. `text` must be valid JSON. */
export function json_range(text, pointer) {
  const scanner = new Scanner(text);
  scanner.value("");
  for (let end = pointer.length; end > 0; end = pointer.lastIndexOf("/", end - 1)) {
    const range = scanner.places.get(pointer.slice(0, end));
    if (range) return range;
  }
  return scanner.places.get("");
}
