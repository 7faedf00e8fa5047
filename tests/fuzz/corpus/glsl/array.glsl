int a[4]; a[uint(2) % 4u] = 0x1f / (1 + 2); /* two
lines */ while (a[2] > 0) a[2] -= 1;
return vec4(dFdx(uv.x), a[2], 0, 1);
