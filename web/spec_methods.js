// The methods of a spec as the form shows them.

export function method_object(method) {
  return typeof method === "string" ? { id: method } : { ...method };
}

/** The methods as objects. */
export function method_specs(model) {
  const methods = model.get(["methods"]);
  return (Array.isArray(methods) ? methods : []).map((method) => method_object(method ?? {}));
}

/** Their labels, numbered as by the service. */
export function labels_of(model) {
  const taken = new Set();
  const specs = method_specs(model);
  for (const { label } of specs) if (label) taken.add(label);
  return specs.map(({ id, label }) => {
    if (label) return label;
    let name = id;
    for (let number = 2; taken.has(name); ++number) name = `${id} ${number}`;
    taken.add(name);
    return name;
  });
}
