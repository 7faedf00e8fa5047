// Asking again while the service is busy: it answers 429 and says when to retry.

const MOST_RETRIES = 20;

function pause(seconds, signal) {
  return new Promise((resolve, reject) => {
    const timer = setTimeout(resolve, seconds * 1000);
    signal?.addEventListener("abort", () => {
      clearTimeout(timer);
      reject(signal.reason);
    });
  });
}

export async function patiently(ask, signal = null) {
  for (let tries = 1; ; ++tries) {
    try {
      return await ask();
    } catch (error) {
      if (error.status !== 429 || tries >= MOST_RETRIES) throw error;
      await pause(error.retry_after_s ?? 1, signal);
    }
  }
}
